// Asks for a scene to open.
#pragma once

#include "app/ui/widgets/file_query.hpp"

namespace flyball {

struct DialogState;
struct Session;
struct Ui;

class OpenDialog {
 public:
  struct Answer {
    std::filesystem::path file; // to be opened; empty: none
    bool examples = false;      // they are asked for instead
  };
  void open(const Session& session, DialogState& dialog);
  Answer draw(Session& session, Ui& ui, DialogState& dialog);
  FileQuery& query() { return query_; } // may be filled in beforehand

 private:
  bool may_open(const std::filesystem::path& file);

  FileQuery query_;
};

} // namespace flyball
