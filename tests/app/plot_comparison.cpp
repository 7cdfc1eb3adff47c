// Error against run time: what of the motion's runs is joined, and what each says of itself.
#include "tests/catch.hpp"

#include "app/plot/comparison_plot.hpp"

#include <algorithm>

using namespace flyball;

namespace {

// Two durations of one integrator; the longer one's second run is later and no nearer than its first.
Comparison measured() {
  Comparison c;
  c.status = Status::converged;
  c.direct = {{1, 1e-2, 1e-6}, {2, 1e-9, 2e-6}};
  c.answer = {2, 1e-16, 5e-6};
  c.motion = {{Integrator::bdf, 10, {{1e-3, 1e-2, 0.01}, {1e-6, 1e-3, 0.03}}},
              {Integrator::bdf, 40, {{1e-3, 1e-4, 0.02}, {1e-6, 1e-4, 0.05}, {1e-9, 1e-8, 0.2}}},
              {Integrator::adams, 40, {{1e-6, 1e-7, 0.1}}}};
  c.best = SpeedRatio{Integrator::bdf, 40, 1e-9, 1e-8, 0.2, 2e-6};
  return c;
}

} // namespace

TEST_CASE("runs that another beats in time and error are not joined", "[plot]") {
  const Plot plot = comparison_plot("", measured());
  REQUIRE(plot.curves.size() == 4);
  const PlotCurve &best = plot.curves[0], &others = plot.curves[1];
  using Points = std::vector<std::array<double, 2>>;
  CHECK(best.name == "BDF");
  CHECK(best.points == Points{{0.01, 1e-2}, {0.02, 1e-4}, {0.2, 1e-8}});
  CHECK(best.line == PlotLine::solid);
  CHECK(others.name == best.name);
  CHECK(others.points == Points{{0.03, 1e-3}, {0.05, 1e-4}});
  CHECK(others.line == PlotLine::none);
  CHECK(plot.curves[2].name == "Adams");
  CHECK(plot.curves[2].points == Points{{0.1, 1e-7}});
  // Each tells what it is.
  REQUIRE(best.notes.size() == 3);
  CHECK(best.notes[0] == "10 s simulated, tolerance 1e-03");
  CHECK(best.notes[2] == "40 s simulated, tolerance 1e-09");
  CHECK(plot.curves[3].notes[1] == "2 iterations");
  const auto nearest = std::ranges::find(plot.marks, "nearest motion", &PlotMark::label);
  REQUIRE(nearest != plot.marks.end());
  CHECK(nearest->at == std::array<double, 2>{0.2, 1e-8});
}
