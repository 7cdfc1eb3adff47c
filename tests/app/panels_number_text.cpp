#include "app/session/number_text.hpp"
#include "app/session/parameter_list.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <tuple>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("a value has the digits its error supports") {
  const NumberStyle style;
  CHECK(value_text(0.7856156814882422, 3e-5, style) == "0.78562");
  CHECK(value_text(45.01246286857, 2e-3, style) == "45.012");
  CHECK(value_text(0.7856156814882422, 1e-16, style) == "0.78561568149");
  CHECK(value_text(150.0174581252971, 1e-13, style) == "150.017458125");
  CHECK(value_text(12.4, 30, style) == "12");
  CHECK(value_text(-1e-14, 1e-3, style) == "0.000");
  CHECK(value_text(0, 0, style) == "0");
  CHECK(value_text(3.2e-9, 1e-11, style) == "3.20e-09");
}

TEST_CASE("magnitudes and run times are short") {
  const NumberStyle style;
  CHECK(magnitude_text(3.14e-14, style) == "3.1e-14");
  CHECK(magnitude_text(1e-17, style) == "< 1e-16");
  CHECK(duration_text(2.44e-6, style) == "2.4 µs");
  CHECK(duration_text(13.2e-3, style) == "13 ms");
  CHECK(duration_text(1.2, style) == "1.2 s");
  CHECK(duration_text(1.2, {.run_times = false}) == "-- µs");
  CHECK(short_text(11.0174) == "11.0174");
  CHECK(short_text(-0.0) == "0");
}

TEST_CASE("rough numbers have three digits and no exponent where none is needed") {
  CHECK(rough_text(1289.4) == "1290");
  CHECK(rough_text(-123456) == "-123000");
  CHECK(rough_text(0.012345) == "0.0123");
  CHECK(rough_text(0) == "0");
  CHECK(rough_text(2.361e7) == "2.36e+07");
}

TEST_CASE("every drive speed and spring constant has a slider, the scene's own first") {
  const Mechanism mechanism = shipped("governor");
  const auto controls = parameter_controls(mechanism, mechanism);
  REQUIRE(controls.size() >= 2);
  CHECK(controls[0].address == "joints.spin.drive.speed");
  CHECK(controls[0].unit == "rad/s");
  CHECK(controls[0].to == 30);
  CHECK_FALSE(controls[0].log);
  CHECK(controls[1].address == "joints.slide.spring.stiffness");
  CHECK(controls[1].log);

  Mechanism bare = mechanism;
  bare.sliders.clear();
  const auto own = parameter_controls(bare, bare);
  REQUIRE(own.size() == 3);
  CHECK(own[2].group == ParameterGroup::dampers);
  CHECK(own[2].unit == "N s/m");
  CHECK(own[0].from == 0);
  CHECK(own[0].to == 50);
  CHECK(own[1].from == 10);
  CHECK(own[1].to == 100000);
  CHECK(own[1].log);
}

TEST_CASE("after a number was tried the sliders are those that would be made anew") {
  Mechanism file = shipped("governor");
  Force damper;
  damper.name = "damper";
  damper.type = ForceType::spring;
  damper.stiffness = 5;
  file.forces.push_back(damper);
  const auto fields = [](const ParameterControl& c) {
    return std::tuple(c.address, c.group, c.name, c.what, c.unit, c.value, c.from, c.to, c.log, c.file_value,
                      c.step);
  };
  int kept = 0;
  for (const std::string& address : parameter_addresses(file))
    for (const double value : {0., 7.})
      for (const double next : {0., 3.}) {
        Mechanism tried = file;
        set_parameter(tried, address, value);
        auto controls = parameter_controls(tried, file);
        set_parameter(tried, address, next);
        if (!take_value(controls, tried, file, address)) continue;
        ++kept;
        INFO(address << " " << value << " " << next);
        CHECK(std::ranges::equal(controls, parameter_controls(tried, file), {}, fields, fields));
      }
  CHECK(kept > 8);
}

TEST_CASE("a slider stops at round values") {
  const Mechanism mechanism = shipped("governor");
  const auto controls = parameter_controls(mechanism, mechanism);
  CHECK(slider_value(controls[0], 0.5, false) == 15);
  CHECK(slider_value(controls[0], 0.34567, false) == 10.4);
  CHECK(slider_value(controls[0], 0, false) == 0);
  CHECK(slider_value(controls[0], 2, false) == 30);
  const double middle = slider_value(controls[1], 0.5, false);
  CHECK(slider_place(controls[1], middle) == Approx(0.5).margin(0.002));
  CHECK(slider_place(controls[1], 1e9) == 1);
}
