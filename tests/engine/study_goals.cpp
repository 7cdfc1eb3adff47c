// Sliders in reverse: numbers moved so that the steady state goes where it is wanted.
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/dice.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/goals.hpp"
#include "engine/study/least_change.hpp"
#include "engine/study/look_around.hpp"

#include <Eigen/QR>

using namespace flyball;
using namespace flyball::test;

namespace {

const std::string speed = "joints.spin.drive.speed";

// The same by trying every set of unknowns at bounds.
double least_distance(const Eigen::MatrixXd& J, const Eigen::VectorXd& b, const Eigen::VectorXd& lower,
                      const Eigen::VectorXd& upper) {
  const Eigen::Index n = J.cols();
  double best = std::numeric_limits<double>::infinity();
  int sets = 1;
  for (Eigen::Index i = 0; i < n; ++i)
    sets *= 3;
  for (int set = 0; set < sets; ++set) {
    Eigen::VectorXd D = Eigen::VectorXd::Zero(n), rest = b;
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0, code = set; i < n; ++i, code /= 3) {
      if (code % 3 == 0)
        free.push_back(i);
      else
        D[i] = code % 3 == 1 ? lower[i] : upper[i];
    }
    rest -= J * D;
    if (!free.empty()) {
      const Eigen::MatrixXd part = J(Eigen::all, free);
      const Eigen::VectorXd found = part.completeOrthogonalDecomposition().solve(rest);
      D(free) = found;
    }
    if ((D.array() >= lower.array() - 1e-12).all() && (D.array() <= upper.array() + 1e-12).all())
      best = std::min(best, (J * D - b).norm());
  }
  return best;
}

} // namespace

TEST_CASE("least squares within bounds, against every set of unknowns at bounds") {
  Dice dice(11);
  for (int run = 0; run < 300; ++run) {
    const int n = 1 + dice.below(4), m = 1 + dice.below(4);
    CAPTURE(run, n, m);
    Eigen::MatrixXd J(m, n);
    Eigen::VectorXd b(m), lower(n), upper(n);
    for (Eigen::Index i = 0; i < m; ++i) {
      b[i] = dice.between(-2, 2);
      for (Eigen::Index k = 0; k < n; ++k)
        J(i, k) = dice.between(-1, 1);
    }
    for (Eigen::Index k = 0; k < n; ++k) {
      lower[k] = dice.between(-1, 0);
      upper[k] = dice.between(0, 1);
    }
    const Eigen::VectorXd D = least_change(J, b, lower, upper, 0, Eigen::VectorXd::Zero(n));
    CHECK((D.array() >= lower.array()).all());
    CHECK((D.array() <= upper.array()).all());
    CHECK((J * D - b).norm() <= least_distance(J, b, lower, upper) + 1e-9);
    // With room enough the shortest of all.
    const Eigen::VectorXd wide = Eigen::VectorXd::Constant(n, 1e6);
    const Eigen::VectorXd shortest = J.completeOrthogonalDecomposition().solve(b);
    CHECK((least_change(J, b, -wide, wide, 0, shortest) - shortest).norm() < 1e-9 * (1 + shortest.norm()));
  }
}

TEST_CASE("one number, one goal: a conical pendulum leans as wanted") {
  const double length = 0.7;
  for (const double angle : {0.4, 0.8, 1.3}) {
    Mechanism m = conical(length, 0, 1);
    set_parameter(m, speed, 4.5);
    const FreeNumber free[]{{speed, 0, 20}};
    const Goal goals[]{{"swing", angle}};
    const GoalAnswer answer = seek_goals(m, free, goals);
    INFO(answer.message);
    REQUIRE(answer.reached);
    CHECK(answer.numbers[0].value ==
          Approx(std::sqrt(standard_gravity / (length * std::cos(angle)))).epsilon(1e-10));
    CHECK(value(answer.solution, "swing") == Approx(angle).margin(1e-11));
    CHECK(answer.solution.stable == true);
    CHECK(answer.iterations < 15);
  }
}

TEST_CASE("two numbers, two goals: arm and collar of the governor") {
  Mechanism m = shipped("governor_parametric"), there = m;
  set_parameters(there, std::vector<ParameterValue>{{"parameters.w", 13}, {"parameters.L", 0.18}});
  const Solution wanted = Analysis(there).solve({});
  REQUIRE(wanted.status == Status::converged);
  const FreeNumber free[]{{"parameters.w", 0, 30}, {"parameters.L", 0.1, 0.3}};
  const Goal goals[]{{"slide", value(wanted, "slide")}, {"arm1", value(wanted, "arm1")}};
  const GoalAnswer answer = seek_goals(m, free, goals);
  INFO(answer.message);
  REQUIRE(answer.reached);
  // By a solve of its own. Other speeds and arms do so, too; these are nearer to where it began.
  set_parameters(there, std::vector<ParameterValue>{{"parameters.w", answer.numbers[0].value},
                                                    {"parameters.L", answer.numbers[1].value}});
  const Solution found = Analysis(there).solve({});
  CHECK(value(found, "slide") == Approx(value(wanted, "slide")).epsilon(1e-10));
  CHECK(value(found, "arm1") == Approx(value(wanted, "arm1")).epsilon(1e-10));
}

TEST_CASE("of many numbers each moves by its part: the least change in parts of their ranges") {
  const Mechanism m = shipped("governor_parametric");
  const FreeNumber free[]{{"parameters.w", 0, 30}, {"parameters.m", 0.2, 5}, {"parameters.k", 200, 5000}};
  const Goal goals[]{{"slide", 0.14}};
  const GoalAnswer answer = seek_goals(m, free, goals);
  INFO(answer.message);
  REQUIRE(answer.reached);
  CHECK(value(answer.solution, "slide") == Approx(0.14).epsilon(1e-10));
  // Lagrange: the change is along the gradient, both scaled.
  Eigen::Vector3d change, gradient;
  Mechanism there = m;
  std::vector<ParameterValue> values;
  for (const GoalAnswer::Number& number : answer.numbers)
    values.push_back({number.address, number.value});
  set_parameters(there, values);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const FreeNumber& number = free[i];
    const double range = number.to - number.from, h = 1e-4 * range;
    change[i] = (values[static_cast<std::size_t>(i)].value - get_parameter(m, number.address)) / range;
    double sides[2];
    for (const int side : {0, 1}) {
      Mechanism beside = there;
      set_parameter(beside, number.address, get_parameter(there, number.address) + (side == 0 ? h : -h));
      sides[side] = value(Analysis(beside).solve({}), "slide");
    }
    gradient[i] = (sides[0] - sides[1]) / (2 * h) * range;
  }
  CHECK(change.normalized().cross(gradient.normalized()).norm() < 1e-4);
}

TEST_CASE("numbers that one goal leaves free end at the least change, however far the way there") {
  // The collar stands at 0.15 m + load / gain, so that the goal is a straight line in the plane of both.
  const Mechanism m = shipped("governor_engine");
  const FreeNumber free[]{{"parameters.gain", 1000, 20000}, {"joints.spin.drive.load", 0, 50}};
  const double gain_range = 19000, load_range = 50, begin = get_parameter(m, "parameters.gain");
  for (const double lift : {0.001, 0.005, 0.02}) {
    const Goal goals[]{{"slide", 0.15 + lift}};
    const GoalAnswer answer = seek_goals(m, free, goals);
    INFO(answer.message);
    CAPTURE(lift);
    REQUIRE(answer.reached);
    // Least ((gain - begin) / its range)^2 + (lift gain / its range)^2, within the ranges.
    const double share = lift * gain_range / load_range,
                 gain = std::clamp(begin / (1 + share * share), 1000., std::min(20000., 50 / lift));
    CHECK(answer.numbers[0].value == Approx(gain).epsilon(1e-5));
    CHECK(answer.numbers[1].value == Approx(lift * gain).epsilon(1e-5));
  }
}

TEST_CASE("what cannot be reached ends at the nearest that can") {
  const Mechanism m = shipped("governor_parametric");
  SECTION("a number at the end of its range") {
    const FreeNumber free[]{{"parameters.w", 5, 12}};
    const Goal goals[]{{"slide", 0.1}};
    const GoalAnswer answer = seek_goals(m, free, goals);
    INFO(answer.message);
    REQUIRE(answer.status == Status::converged);
    CHECK_FALSE(answer.reached);
    CHECK(answer.numbers[0].value == 12);
    CHECK(answer.numbers[0].at_limit);
    CHECK_THAT(answer.message, ContainsSubstring("At the end of its range: parameters.w"));
    CHECK(answer.goals[0].value == Approx(value(answer.solution, "slide")).epsilon(1e-12));
  }
  SECTION("another takes over from it") {
    const FreeNumber free[]{{"parameters.w", 5, 12}, {"parameters.k", 200, 5000}};
    const Goal goals[]{{"slide", 0.142}};
    const GoalAnswer answer = seek_goals(m, free, goals);
    INFO(answer.message);
    CHECK(answer.reached);
  }
  SECTION("goals that do not agree") {
    // Arm and collar are tied by the link: at the nearest neither speed leads nearer.
    const FreeNumber free[]{{"parameters.w", 0, 30}};
    const double reach = 0.3; // m
    const Goal goals[]{{"slide", 0.15, reach}, {"arm1", 0.9, 1}};
    const GoalAnswer answer = seek_goals(m, free, goals);
    INFO(answer.message);
    REQUIRE(answer.status == Status::converged);
    CHECK_FALSE(answer.reached);
    const auto distance = [&](double w) {
      Mechanism beside = m;
      set_parameter(beside, "parameters.w", w);
      const Solution s = Analysis(beside).solve({});
      return std::hypot((value(s, "slide") - 0.15) / reach, value(s, "arm1") - 0.9);
    };
    const double w = answer.numbers[0].value;
    CHECK(w > 5);
    CHECK(w < 29);
    CHECK(distance(w) < distance(w - 0.3));
    CHECK(distance(w) < distance(w + 0.3));
  }
  SECTION("beyond a fold") {
    // Of a pendulum hinged off the axis the branch that leans in ends where it folds.
    Mechanism leaning = conical(0.7, 0.1, 1);
    set_parameter(leaning, speed, 8);
    SolveOptions inwards;
    inwards.start = {{"swing", -1.3}};
    inwards.nearest = true;
    const Solution in = Analysis(leaning).solve(inwards);
    REQUIRE(in.status == Status::converged);
    REQUIRE(in.stable == true);
    GoalOptions options;
    options.start = start_values(in.coordinates);
    const FreeNumber free[]{{speed, 0, 20}};
    const Goal goals[]{{"swing", -0.1}};
    const GoalAnswer answer = seek_goals(leaning, free, goals, options);
    INFO(answer.message);
    REQUIRE(answer.status == Status::converged);
    CHECK_FALSE(answer.reached);
    CHECK(answer.goals[0].value < -0.5);
    CHECK(answer.goals[0].value > value(in, "swing"));
  }
}

TEST_CASE("goals by measures") {
  Mechanism m = shipped("governor_parametric");
  m.measures = {{"radius", "", "hypot(x(ball1), z(ball1))", "m"},
                {"height", "", "P.y - y(ball1)", "m"},
                {"ball_speed", "", "speed(ball1)", "m/s"},
                {"pull", "", "acceleration(ball1) * mass(ball1)", "N"},
                {"room", "", "distance(ball1, ball2) - L", "m"},
                {"held", "", "reaction(arm1)", "N"}};
  for (const NamedMeasure& measure : m.measures) {
    CAPTURE(measure.name);
    Mechanism there = m;
    set_parameter(there, "parameters.w", 12.3);
    const Solution wanted = Analysis(there).solve({});
    const auto found = std::ranges::find(wanted.measures, measure.name, &MeasureSolution::name);
    REQUIRE(found != wanted.measures.end());
    REQUIRE(found->value.has_value());
    const Solution before = Analysis(m).solve({});
    const auto now = std::ranges::find(before.measures, measure.name, &MeasureSolution::name);
    if (std::abs(*now->value - *found->value) < 1e-6 * std::abs(*found->value)) continue; // does not move
    const FreeNumber free[]{{"parameters.w", 0, 30}};
    const Goal goals[]{{measure.name, *found->value}};
    const GoalAnswer answer = seek_goals(m, free, goals);
    INFO(answer.message);
    REQUIRE(answer.reached);
    CHECK(answer.numbers[0].value == Approx(12.3).epsilon(1e-6));
  }
}

TEST_CASE("random mechanisms find back to where two of their numbers had brought them") {
  int tried = 0, reached = 0;
  for (std::uint32_t seed = 1; tried < 40 && seed < 600; ++seed) {
    CAPTURE(seed);
    const Mechanism m = reference::random_mechanism(seed);
    SolveOptions quick;
    quick.search = 0;
    const Solution start = Analysis(m).solve(quick);
    if (start.status != Status::converged || start.stable != true || start.coordinates.empty()) continue;
    Dice dice(seed);
    std::vector<FreeNumber> free;
    Mechanism there = m;
    std::vector<std::string> addresses;
    for (const Body& body : m.bodies)
      if (body.mass > 0) addresses.push_back("bodies." + body.name + ".mass");
    for (const Joint& joint : m.joints)
      for (std::size_t k = 0; k < joint.coordinates.size(); ++k)
        if (joint.coordinates[k].drive && joint.coordinates.size() == 1)
          addresses.push_back("joints." + joint.name + ".drive.speed");
    while (free.size() < 2 && !addresses.empty()) {
      const auto at = addresses.begin() + dice.below(static_cast<int>(addresses.size()));
      const double number = get_parameter(m, *at), half = 0.1 * std::abs(number);
      if (half > 0) {
        set_parameter(there, *at, number * dice.between(0.97, 1.03));
        free.push_back({*at, number - half, number + half});
      }
      addresses.erase(at);
    }
    if (free.empty()) continue;
    SolveOptions near;
    near.start = start_values(start.coordinates);
    near.nearest = true;
    const Solution moved = Analysis(there).solve(near);
    if (moved.status != Status::converged) continue;
    std::vector<Goal> goals;
    for (const CoordinateSolution& c : moved.coordinates)
      if (!c.driven && !c.dependent && goals.size() < free.size())
        goals.push_back({coordinate_label(c), c.value});
    if (goals.empty()) continue;
    ++tried;
    GoalOptions options;
    options.start = start_values(start.coordinates);
    const GoalAnswer answer = seek_goals(m, free, goals, options);
    INFO(answer.message);
    REQUIRE(answer.status == Status::converged);
    if (!answer.reached) continue;
    ++reached;
    for (const Goal& goal : goals)
      for (const CoordinateSolution& c : answer.solution.coordinates)
        if (coordinate_label(c) == goal.wanted) CHECK(std::abs(c.value - goal.value) < 1e-7);
  }
  CHECK(tried >= 30);
  CHECK(reached >= tried * 9 / 10);
}

TEST_CASE(
    "what is least is not a maximum or a saddle on which the search begins, and nothing where nothing acts") {
  Mechanism m = parse_scene(R"s({"flyball": 2, "name": "two slides",
    "parameters": {"F": {"value": 0, "unit": "N"}, "G": {"value": 0, "unit": "N"}},
    "bodies": [{"name": "b", "mass": 1, "position": [0, 0, 0]}, {"name": "c", "mass": 1, "position": [0, 1, 0]}],
    "joints": [
      {"name": "x", "type": "prismatic", "bodies": ["ground", "b"], "at": [0, 0, 0], "axis": [1, 0, 0],
       "spring": {"stiffness": 100}},
      {"name": "y", "type": "prismatic", "bodies": ["ground", "c"], "at": [0, 1, 0], "axis": [1, 0, 0],
       "spring": {"stiffness": 100}}],
    "forces": [{"name": "f", "type": "force", "body": "b", "at": [0, 0, 0], "vector": ["=F", 0, 0]},
               {"name": "g", "type": "force", "body": "c", "at": [0, 1, 0], "vector": ["=G", 0, 0]}],
    "measures": {"hill": {"value": "=-coordinate(x)^2", "unit": "m^2"},
                 "saddle": {"value": "=coordinate(x)*coordinate(y)", "unit": "m^2"},
                 "valley": {"value": "=coordinate(x)^2 + coordinate(y)^2", "unit": "m^2"},
                 "corner": {"value": "=-coordinate(x)*coordinate(y)", "unit": "m^2"},
                 "capped": {"value": "=1 - (coordinate(x)/(50 mm))^4", "unit": ""},
                 "level": {"value": "=1 + (coordinate(x)/(50 mm))^6", "unit": ""},
                 "sum": {"value": "=coordinate(x) + coordinate(y)", "unit": "m"}}})s");
  const FreeNumber one[]{{"parameters.F", -4, 5}};
  const GoalAnswer top = minimize(m, one, "hill", {});
  INFO(top.message);
  CHECK(std::abs(top.least->value) >= 0.04 * 0.04 - 1e-12); // at one of the ends

  const FreeNumber both[]{{"parameters.F", -5, 5}, {"parameters.G", -5, 5}};
  CHECK(minimize(m, both, "saddle", {}).least->value == Approx(-0.05 * 0.05));
  // The goal keeps y = -x: what is least there is at an end, too.
  const Goal level[]{{"sum", 0}};
  CHECK(minimize(m, both, "saddle", level).least->value == Approx(-0.05 * 0.05));

  const GoalAnswer bottom = minimize(m, both, "valley", {});
  CHECK(bottom.numbers[0].value == 0);
  CHECK(bottom.message.find("a minimum nearby") != std::string::npos);
  // Nothing is less where the goal leaves nothing open.
  Mechanism governor = shipped("governor_parametric");
  const FreeNumber balls[]{{"parameters.w", 5, 30}, {"parameters.m", 0.2, 5}};
  const Goal stands[]{{"slide", 0.145}};
  const GoalAnswer fixed = minimize(governor, balls, "radius", stands);
  INFO(fixed.message);
  CHECK(fixed.reached);
  CHECK(fixed.goals[0].value == Approx(0.145).epsilon(1e-10));
  // On a circle, from its top and from beside it.
  const Goal around[]{{"valley", 0.0009}};
  for (const double start : {0., 1., 2.}) {
    const Mechanism there = with_parameter(with_parameter(m, "parameters.F", start), "parameters.G", 3);
    CHECK(minimize(there, both, "y", around).least->value == Approx(-0.03));
  }
  // At a corner of the ranges neither number changes anything by itself.
  const FreeNumber quarter[]{{"parameters.F", 0, 5}, {"parameters.G", 0, 5}};
  CHECK(minimize(m, quarter, "corner", {}).least->value == Approx(-0.05 * 0.05));
  // What goes with the fourth or the sixth power changes nothing close by.
  CHECK(minimize(m, one, "capped", {}).least->value < 1 - std::pow(0.8, 4) + 1e-12);
  const GoalAnswer trough = minimize(m, one, "level", {});
  INFO(trough.message);
  CHECK(trough.least->value == Approx(1));
  CHECK(trough.message.find("a minimum nearby") != std::string::npos);
  const GoalAnswer idle = minimize(m, one, "y", {});
  CHECK(idle.numbers[0].value == 0);
  CHECK(idle.message.find("none of the numbers that may move changes it") != std::string::npos);
}

TEST_CASE("around a place where no slope leads down there is less, or not, as of closed forms") {
  using Place = std::optional<PlaceBeside>;
  // Around the x at which f has the slope zero, of f and its gradient.
  const auto around = [](const Eigen::VectorXd& x, const auto& f, const auto& slope) {
    const auto evaluate = [&](const Eigen::VectorXd& at) -> Place {
      return PlaceBeside{f(at), Eigen::VectorXd(0), Eigen::MatrixXd(slope(at).transpose())};
    };
    return look_around(x, *evaluate(x), evaluate);
  };
  using V = Eigen::VectorXd;
  const auto v = [](double x, double y) -> V { return Eigen::Vector2d(x, y); };
  const V corner = v(0, 1), middle = v(0.5, 0.5);

  // From a corner of the unit square less lies between its sides alone, and along them nothing changes.
  const auto between = around(
      corner, [](const V& at) { return -at[0] * (1 - at[1]); },
      [&](const V& at) { return v(at[1] - 1, at[0]); });
  REQUIRE(between.lower);
  CHECK(((*between.lower)[0] > 0 && (*between.lower)[1] < 1));
  CHECK_FALSE(between.flat);
  const auto valley = around(
      corner, [](const V& at) { return at[0] * (1 - at[1]); },
      [&](const V& at) { return v(1 - at[1], -at[0]); });
  CHECK_FALSE(valley.lower);
  CHECK_FALSE(valley.flat);

  // 1 +- (x - 1/2)^4, of which close by nothing is noticed.
  for (const double side : {1., -1.}) {
    const auto fourth = around(
        middle, [&](const V& at) { return 1 + side * std::pow(at[0] - 0.5, 4); },
        [&](const V& at) { return v(4 * side * std::pow(at[0] - 0.5, 3), 0); });
    CHECK(fourth.lower.has_value() == (side < 0));
    CHECK_FALSE(fourth.flat);
  }
  // x^4 + y^4 - 3 x^2 y^2 is less on the diagonals alone.
  const auto star = around(
      middle,
      [](const V& at) {
        const double x = at[0] - 0.5, y = at[1] - 0.5;
        return std::pow(x, 4) + std::pow(y, 4) - 3 * x * x * y * y;
      },
      [&](const V& at) {
        const double x = at[0] - 0.5, y = at[1] - 0.5;
        return v(4 * std::pow(x, 3) - 6 * x * y * y, 4 * std::pow(y, 3) - 6 * x * x * y);
      });
  CHECK(star.lower.has_value());
  const auto idle = around(
      middle, [](const V&) { return 7.; }, [&](const V&) { return v(0, 0); });
  CHECK(idle.flat);
  CHECK_FALSE(idle.lower);

  // On a circle about the middle, y kept least: at its top is the most.
  const auto on_circle = [&](const V& at) -> Place {
    const double x = at[0] - 0.5, y = at[1] - 0.5;
    Eigen::Matrix2d slopes;
    slopes << 2 * x, 2 * y, 0, 1;
    return PlaceBeside{at[1], V::Constant(1, x * x + y * y - 0.09), slopes};
  };
  const V top = v(0.5, 0.8), bottom = v(0.5, 0.2), side = v(0.8, 0.5);
  CHECK(look_around(top, *on_circle(top), on_circle).lower.has_value());
  CHECK_FALSE(look_around(bottom, *on_circle(bottom), on_circle).lower.has_value());
  CHECK(look_around(side, *on_circle(side), on_circle).slopes);
}

TEST_CASE("around a plain minimum between two numbers is looked where that may tell something") {
  using V = Eigen::VectorXd;
  // Of 1 + sum c_i (x_i - m_i)^2 + bend a^2 b^2, a and b the first two numbers from m, at x.
  const auto looks = [](const V& x, const V& m, const V& c, double bend) {
    int count = 0;
    const auto evaluate = [&](const V& at) -> std::optional<PlaceBeside> {
      ++count;
      const V d = at - m;
      V slope = 2 * c.cwiseProduct(d);
      slope[0] += 2 * bend * d[0] * d[1] * d[1];
      slope[1] += 2 * bend * d[0] * d[0] * d[1];
      return PlaceBeside{1 + c.dot(d.cwiseAbs2()) + bend * d[0] * d[0] * d[1] * d[1], V(0),
                         Eigen::MatrixXd(slope.transpose())};
    };
    const PlaceBeside here = *evaluate(x);
    count = 0;
    const Surroundings around = look_around(x, here, evaluate);
    return std::pair{count, around.lower.has_value()};
  };
  const int n = 6;
  const V middle = V::Constant(n, 0.5), zero = V::Zero(n), one = V::Ones(n);
  // Within the ranges to and fro along each.
  CHECK(looks(middle, middle, one, 0) == std::pair{2 * n, false});
  // At the lower ends of all, where it rises along each: along each, and along the diagonals inwards.
  CHECK(looks(zero, V::Constant(n, -0.1), one, 0) == std::pair{n + n * (n - 1) / 2, false});
  // One number at its end: with each of the others along the two diagonals inwards.
  V at_end = middle, beyond = middle;
  at_end[2] = 1;
  beyond[2] = 1.1;
  CHECK(looks(at_end, beyond, one, 0) == std::pair{2 * n - 1 + 2 * (n - 1), false});
  // What curvature hardly shows is looked at: less lies on the diagonals of the first two, one step farther.
  V soft = one;
  soft.head(2).setConstant(1e-6);
  CHECK(looks(middle, middle, soft, -1).second);
}

TEST_CASE("what is least: against a search along one number, and with a goal kept") {
  Mechanism m = shipped("governor_parametric");
  m.measures = {{"odd", "", "(coordinate(slide) - 0.146 m)^2", "m^2"}, {"pull", "", "reaction(arm1)", "N"}};
  const FreeNumber speeds[]{{"parameters.w", 5, 30}};
  const GoalAnswer answer = minimize(m, speeds, "odd", {});
  INFO(answer.message);
  REQUIRE(answer.status == Status::converged);
  CHECK(value(answer.solution, "slide") == Approx(0.146).margin(1e-6));
  CHECK(answer.least->value < 1e-12);

  // The reaction of an arm with the collar where it is: by every arm and the speed that it then takes.
  const FreeNumber both[]{{"parameters.w", 5, 30}, {"parameters.m", 0.2, 5}, {"parameters.k", 200, 5000}};
  const Goal kept[]{{"slide", 0.145}};
  const GoalAnswer least = minimize(m, both, "pull", kept);
  INFO(least.message);
  REQUIRE(least.status == Status::converged);
  CHECK(least.goals[0].value == Approx(0.145).epsilon(1e-9));
  CHECK(least.least->value < least.least->goal);
  // No neighbour that keeps the goal has less.
  Mechanism there = m;
  for (const GoalAnswer::Number& number : least.numbers)
    set_parameter(there, number.address, number.value);
  for (std::size_t i = 0; i < 3; ++i)
    for (const double by : {-0.03, 0.03}) {
      Mechanism beside = there;
      const FreeNumber& number = both[i];
      const double moved = std::clamp(get_parameter(there, number.address) + by * (number.to - number.from),
                                      number.from, number.to);
      set_parameter(beside, number.address, moved);
      std::vector<FreeNumber> rest;
      for (std::size_t k = 0; k < 3; ++k)
        if (k != i) rest.push_back(both[k]);
      const GoalAnswer back = seek_goals(beside, rest, kept);
      if (!back.reached) continue;
      const double pull =
          std::ranges::find(back.solution.measures, "pull", &MeasureSolution::name)->value.value();
      CHECK(pull >= least.least->value * (1 - 1e-6));
    }
}

TEST_CASE("goals that make no sense are refused") {
  const Mechanism m = shipped("governor_parametric");
  const FreeNumber free[]{{"parameters.w", 0, 30}};
  const Goal goals[]{{"slide", 0.14}};
  CHECK_THROWS_AS(seek_goals(m, {}, goals), SceneError);
  CHECK_THROWS_AS(seek_goals(m, free, {}), SceneError);
  const Goal unknown[]{{"slid", 0.14}};
  CHECK_THROWS_AS(seek_goals(m, free, unknown), SceneError);
  const Goal driven[]{{"spin", 0.14}};
  CHECK_THROWS_AS(seek_goals(m, free, driven), SceneError);
  const FreeNumber empty[]{{"parameters.w", 3, 3}};
  CHECK_THROWS_AS(seek_goals(m, empty, goals), SceneError);
  const FreeNumber given[]{{"parameters.c", 0, 1}}; // by an expression
  CHECK_THROWS_AS(seek_goals(m, given, goals), SceneError);
  const FreeNumber twice[]{{"parameters.w", 0, 30}, {"parameters.w", 0, 30}};
  CHECK_THROWS_AS(seek_goals(m, twice, goals), SceneError);
}
