// Writes the linear model that is shown into a file.
#pragma once

#include "app/ui/widgets/file_query.hpp"

namespace flyball {

struct DialogState;
struct Session;
struct Ui;

class ModelDialog {
 public:
  void open(const Session& session, DialogState& dialog);
  void draw(Session& session, Ui& ui, DialogState& dialog);
  FileQuery& query() { return query_; } // may be filled in beforehand

 private:
  FileQuery query_;
};

} // namespace flyball
