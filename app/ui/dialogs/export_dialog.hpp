// Asks for a picture of what is seen.
#pragma once

#include "app/ui/export_request.hpp"
#include "app/ui/widgets/file_query.hpp"

#include <optional>
#include <string>

namespace flyball {

struct DialogState;
struct Session;
struct Ui;

class ExportDialog {
 public:
  // Afresh: with the size and panels of the last picture that was saved.
  void open(const Session& session, DialogState& dialog, bool loads);
  // Returns the picture that is asked for.
  std::optional<ExportRequest> draw(Session& session, Ui& ui, DialogState& dialog);
  // Again as it was, saying why the picture was not written.
  void refuse(DialogState& dialog, std::string why);
  FileQuery& query() { return query_; } // may be filled in beforehand

  bool loads() const { return loads_; }

 private:
  struct Choices {
    int width = 1920, height = 1080; // pixels
    bool panels = false;
  };

  FileQuery query_;
  Choices now_, saved_; // in the dialog, and of the last picture
  bool loads_ = false;
};

} // namespace flyball
