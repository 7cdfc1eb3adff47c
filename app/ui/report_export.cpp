#include "app/ui/report_export.hpp"

#include "app/report/page.hpp"
#include "app/ui/app.hpp"
#include "app/ui/snapshot.hpp"
#include "engine/mechanism/file.hpp"

#include <utility>

namespace flyball {
namespace {

struct Pictures {
  Image light, dark;
  std::string problem; // why there are none
};

Pictures both_pictures(App& app, PixelSize size) {
  Pictures out;
  const Theme theme = app.ui.theme;
  const Mode mode = app.session.mode;
  try {
    app.session.mode = Mode::explore; // the steady state
    app.ui.theme = Theme::light;
    out.light = view_picture(app, size);
    app.ui.theme = Theme::dark;
    out.dark = view_picture(app, size);
  } catch (const std::exception& error) {
    out.problem = error.what();
  }
  app.ui.theme = theme;
  app.session.mode = mode;
  return out;
}

std::vector<ExploredNumber> explored_numbers(const Document& document) {
  std::vector<ExploredNumber> all;
  for (const ExploredValue& each : document.explored())
    if (const auto in_file = find_number(document.stored(), each.address);
        in_file && find_number(*document.shared(), each.address) != in_file)
      all.push_back({each.address, *in_file});
  return all;
}

} // namespace

void begin_report(App& app, const ExportRequest& request) {
  using Task = Background<std::filesystem::path>;
  const PixelSize size{request.width, request.height};
  const auto pictures = std::make_shared<const Pictures>(both_pictures(app, size));
  if (!app.report.task)
    app.report.task = std::make_unique<Task>(app.session.options.mode, app.session.options.on_news);
  ReportOptions options;
  // The state that a hand has chosen, if one has.
  if (app.session.on_branch && converged(app.session)) {
    options.start = start_values(app.session.answer.solution.coordinates);
    options.nearest = true;
  }
  app.session.notice = "Writing the report…";
  app.report.task->start([options, size, pictures, file = request.file,
                          mechanism = app.session.document.shared(),
                          scene = app.session.document.file().filename().string(),
                          explored = explored_numbers(app.session.document)](
                             const TaskContext<std::filesystem::path>& context) mutable {
    options.cancel = &context.cancel;
    options.progress = context.progress;
    ReportContents contents = report_contents(mechanism, options);
    if (context.cancel) return std::filesystem::path(); // nobody is there any more
    report_progress(context.progress, "writing the page");
    contents.scene = scene;
    contents.date = report_date();
    contents.explored = explored;
    contents.picture.problem = pictures->problem;
    if (pictures->problem.empty())
      contents.picture = {encode_png(pictures->light), encode_png(pictures->dark), size.width, size.height,
                          ""};
    replace_file(file, report_page(contents));
    return file;
  });
}

bool writing_report(const ReportExport& report) {
  return report.task && report.task->running();
}

void update_report(Session& session, ReportExport& report) {
  const auto news = report.task ? report.task->take() : std::nullopt;
  if (!news) return;
  if (!news->problem.empty())
    show_error(session, "Not saved: " + news->problem);
  else if (news->result)
    session.notice =
        news->result->empty() ? "The report was not written." : "Saved " + news->result->string();
}

} // namespace flyball
