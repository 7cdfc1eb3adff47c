// Asks for a file to save the document to.
#pragma once

#include "app/ui/widgets/file_query.hpp"

namespace flyball {

struct DialogState;
struct Session;
struct Ui;

class SaveDialog {
 public:
  enum class Answer { none, saved, cancelled };
  // `why`: it could not be saved to the file it has; may be empty.
  void open(const Session& session, DialogState& dialog, std::string why);
  Answer draw(Session& session, Ui& ui, DialogState& dialog);
  FileQuery& query() { return query_; } // may be filled in beforehand

 private:
  bool save(Session& session);

  FileQuery query_;
};

} // namespace flyball
