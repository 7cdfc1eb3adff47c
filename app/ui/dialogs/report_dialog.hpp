// Asks for a report of the steady state.
#pragma once

#include "app/ui/export_request.hpp"
#include "app/ui/widgets/file_query.hpp"

#include <optional>

namespace flyball {

struct DialogState;
struct Session;
struct Ui;

class ReportDialog {
 public:
  void open(const Session& session, DialogState& dialog);
  // Returns the report that is asked for; none while another is written.
  std::optional<ExportRequest> draw(Session& session, Ui& ui, DialogState& dialog, bool writing);
  FileQuery& query() { return query_; } // may be filled in beforehand

 private:
  FileQuery query_;
};

} // namespace flyball
