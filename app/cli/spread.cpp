#include "engine/study/spread.hpp"
#include "app/cli/command.hpp"
#include "app/cli/npz.hpp"
#include "app/cli/output.hpp"
#include "app/cli/processes.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/row_columns.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "app/cli/spread_report.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/study/spread_tally.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

namespace flyball::cli {
namespace {

struct SpreadArguments {
  SceneArgument scene;
  std::vector<std::string> tolerance;
  std::size_t samples = 1000;
  std::uint64_t seed = 1;
  std::string csv, npz, shard;
  bool json = false;
};

// "address=normal:0.1 mm", "address=uniform:2%": of the nominal value.
Tolerance parse_tolerance(const Mechanism& mechanism, std::string_view text) {
  const auto fail = [&] {
    return SceneError("--tolerance",
                      "expected address=normal:WIDTH, uniform:WIDTH or triangular:WIDTH, not \"" +
                          std::string(text) + "\"");
  };
  const std::size_t equals = text.find('='), colon = text.find(':', equals);
  if (equals == std::string_view::npos || equals == 0 || colon == std::string_view::npos) throw fail();
  Tolerance tolerance;
  tolerance.address = text.substr(0, equals);
  const std::string_view kind = text.substr(equals + 1, colon - equals - 1);
  bool known = false;
  for (const Distribution each : {Distribution::normal, Distribution::uniform, Distribution::triangular})
    if (kind == word(each)) {
      tolerance.distribution = each;
      known = true;
    }
  if (!known) throw fail();
  const std::string where = "--tolerance " + tolerance.address;
  const double nominal = get_parameter(mechanism, tolerance.address);
  std::string_view width = text.substr(colon + 1);
  if (width.ends_with('%')) {
    width.remove_suffix(1);
    tolerance.width = std::abs(nominal) * parse_number(where, width) / 100;
  } else {
    tolerance.width =
        evaluate_expression(mechanism, width, parameter_unit(mechanism, tolerance.address), where);
  }
  if (!(tolerance.width > 0)) throw SceneError(where, "expected a width above zero");
  return tolerance;
}

// Where samples go as they come, some at a time.
class SampleFiles {
 public:
  SampleFiles(const SpreadArguments& arguments, const StudyPart& part) : columns_(part.columns) {
    if (!arguments.csv.empty())
      csv_ = arguments.shard.empty() ? csv_output(arguments.csv, csv_head(part.columns))
                                     : part_output(part, arguments.csv);
    if (!arguments.npz.empty()) npz_.emplace(arguments.npz, npz_columns(part.columns), part.count);
    if (csv_) csv_->begin();
  }

  void add(const SpreadReport& report, std::size_t i, SampleFate fate, std::span<const double> values) {
    if (!csv_ && !npz_) return;
    const std::string row = sample_row(report, i, fate, values);
    if (csv_) rows_ += row;
    if (npz_) columns_.add(std::string_view(row).substr(0, row.size() - 1));
    constexpr std::size_t some = 1000;
    if (++waiting_ == some) put_out();
  }
  void finish() {
    put_out();
    if (csv_) csv_->finish();
    if (npz_) npz_->finish();
  }

 private:
  void put_out() {
    if (csv_) csv_->take(done_, done_ + waiting_, rows_);
    if (npz_) npz_->write(done_, done_ + waiting_, columns_.take());
    rows_.clear();
    done_ += std::exchange(waiting_, 0);
  }

  std::unique_ptr<RowOutput> csv_;
  std::optional<NpzWriter> npz_;
  std::string rows_;
  RowColumns columns_;
  std::size_t waiting_ = 0, done_ = 0; // samples
};

// Makes samples and puts them out; what they tell goes to the tally.
void make(const Mechanism& mechanism, const SpreadArguments& arguments, const StudyPart& part,
          WorkSharing& sharing, const SpreadReport& report, SpreadTally& tally) {
  std::optional<SampleFiles> files;
  if (sharing.takes()) files.emplace(arguments, part);
  SpreadOptions options;
  options.seed = arguments.seed;
  ProgressBar progress("solving");
  options.progress = [&](std::size_t done, std::size_t all) { progress.show("solving", done, all); };
  make_samples(mechanism, report.tolerances, options, part.begin(), part.end() - part.begin(), sharing,
               [&](std::size_t i, SampleFate fate, std::span<const double> values) {
                 files->add(report, i, fate, values);
                 tally.add(i, fate, values);
               });
  if (files) files->finish();
}

void run(const SpreadArguments& arguments, Ending& ending) {
  const auto begin = std::chrono::steady_clock::now();
  check_outputs(arguments.scene.file, {{"--csv", arguments.csv}, {"--npz", arguments.npz}});
  const std::unique_ptr<WorkSharing> sharing = share_work();
  const Mechanism mechanism = arguments.scene.load();
  const std::optional<Shard> shard =
      arguments.shard.empty() ? std::nullopt : std::optional(parse_shard("--shard", arguments.shard));
  SpreadReport report{mechanism.name, warnings_json(find_warnings(mechanism)), {}, arguments.seed, {}};
  try {
    for (const std::string& text : arguments.tolerance)
      report.tolerances.push_back(parse_tolerance(mechanism, text));
    report.answer = spread_by_rates(mechanism, report.tolerances, {});
  } catch (const SceneError& error) {
    throw arguments.scene.in_file(error);
  }
  const bool any = report.answer.status == Status::converged;
  if (any) {
    StudyPart part = sample_part(mechanism, report, arguments.samples);
    part.shard = shard.value_or(Shard{});
    SpreadTally tally(report.tolerances, arguments.seed, report.answer);
    make(mechanism, arguments, part, *sharing, report, tally);
    if (sharing->takes() && !shard) tally.tell(report.answer);
  }
  if (!sharing->takes()) return;
  ending = end_with(any, arguments.scene.file, report.answer.message);
  if (arguments.csv == "-" || (any && shard)) return;
  report.answer.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (arguments.json)
    print_json(to_json(report));
  else if (any)
    print_text(to_text(report));
}

} // namespace

void add_spread(CLI::App& app, Ending& ending) {
  auto arguments = std::make_shared<SpreadArguments>();
  CLI::App* command =
      app.add_subcommand("spread", "Tell how the steady state scatters with tolerances of numbers");
  arguments->scene.add_to(*command);
  command
      ->add_option(
          "--tolerance", arguments->tolerance,
          "A number's tolerance: address=normal:DEVIATION, =uniform:HALF or =triangular:HALF, with a unit or "
          "in % of the number; given again, several")
      ->required()
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--samples", arguments->samples, "How many samples")
      ->check(CLI::Range(2., 1e8)) // one has no deviation
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Which samples: the same seed gives the same to the bit")
      ->capture_default_str();
  CLI::Option* csv =
      command->add_option("--csv", arguments->csv, "Write the samples to a file (-: standard output)");
  CLI::Option* npz = command->add_option("--npz", arguments->npz, "Write them as columns for NumPy");
  CLI::Option* json = command->add_flag("--json", arguments->json, "Print a JSON object");
  add_shard(*command, arguments->shard, csv)->excludes(json)->excludes(npz); // which `merge` makes
  command->footer("Example: flyball spread governor.json --tolerance joints.slide.spring.stiffness=normal:2% "
                  "--samples 10000");
  command->callback([arguments, &ending] { run(*arguments, ending); });
}

} // namespace flyball::cli
