#include "engine/mechanism/decimal.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"

#include "tests/catch.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <tuple>

using namespace flyball;

TEST_CASE("Numbers are as short as they can be and read back exactly") {
  CHECK(number_text(200) == "200");
  CHECK(number_text(0.1) == "0.1");
  CHECK(number_text(-0.0) == "-0.0");
  CHECK(number_text(1e300) == "1e+300");
  for (const double value : {1.0 / 3, 0.45377171949723577, std::numeric_limits<double>::denorm_min(),
                             std::numeric_limits<double>::max()})
    CHECK(std::stod("0" + number_text(value / 2)) == value / 2);
}

// Whichever way the library reads them.
TEST_CASE("A decimal number is read as far as it goes") {
  const auto read = [](std::string_view text) {
    double value = 7;
    const auto [end, error] = read_decimal(text.data(), text.data() + text.size(), value);
    return std::tuple(value, end - text.data(), error);
  };
  const std::errc none{}, range = std::errc::result_out_of_range, invalid = std::errc::invalid_argument;
  CHECK(read("-12.5e-3 m") == std::tuple(-0.0125, 8, none));
  CHECK(read("2.5eV") == std::tuple(2.5, 3, none));
  CHECK(read("0x10") == std::tuple(0., 1, none));
  CHECK(read(".5") == std::tuple(0.5, 2, none));
  CHECK(read("5.") == std::tuple(5., 2, none));
  CHECK(read("4.9406564584124654e-324") == std::tuple(std::numeric_limits<double>::denorm_min(), 23, none));
  CHECK(read("0e-999") == std::tuple(0., 6, none));
  CHECK(read("1e999 m") == std::tuple(7., 5, range));
  CHECK(read("1e-999") == std::tuple(7., 6, range));
  for (const std::string_view text : {"", "+1", " 1", ".", "-", "-.e5", "e5"})
    CHECK(read(text) == std::tuple(7., 0, invalid));
  CHECK(std::isinf(std::get<double>(read("inf"))));
}

TEST_CASE("The nearest word is what a person meant") {
  constexpr std::array<std::string_view, 4> words{"axis", "axes", "bodies", "stiffness"};
  CHECK(nearest_word("axs", words) == "axis");
  CHECK(nearest_word("Bodys", words) == "bodies");
  CHECK(nearest_word("stifness", words) == "stiffness");
  CHECK(nearest_word("gravity", words).empty());
  CHECK(nearest_word("", words).empty());
  CHECK(nearest_word(std::string(100000, 'a'), words).empty());
  CHECK(word_list(words) == "axis, axes, bodies or stiffness");
}

TEST_CASE("Text is UTF-8 or not") {
  for (const char* good : {"", "plain", "ü", "球", "🜚", "\xED\x9F\xBF"})
    CHECK(find_invalid_utf8(good) == std::string::npos);
  CHECK(find_invalid_utf8("a\x80") == 1);
  CHECK(find_invalid_utf8("\xC0\x80") == 0);
  CHECK(find_invalid_utf8("\xE0\x80\x80") == 0);
  CHECK(find_invalid_utf8("ab\xF4\x90\x80\x80") == 2);
  CHECK(find_invalid_utf8("\xE7\x90") == 0);
}

TEST_CASE("Joint types have their coordinates") {
  CHECK(coordinate_count(JointType::free) == 6);
  CHECK(coordinate_count(JointType::distance) == 0);
  CHECK(is_angle(JointType::cylindrical, 0));
  CHECK_FALSE(is_angle(JointType::cylindrical, 1));
  CHECK(is_angle(JointType::planar, 2));
  CHECK_FALSE(is_angle(JointType::free, 2));
  CHECK(is_rotation_vector(JointType::free, 3));
  CHECK_FALSE(is_rotation_vector(JointType::planar, 2));
}

TEST_CASE("Coordinates are found by name and named") {
  Mechanism m;
  Joint joint;
  joint.name = "one";
  m.joints.push_back(joint);
  joint.name = "two";
  joint.type = JointType::universal;
  m.joints.push_back(joint);
  CHECK(find_coordinate(m, "one").joint == 0);
  CHECK(find_coordinate(m, "two.1").joint == 1);
  CHECK(find_coordinate(m, "two.1").coordinate == 1);
  for (const char* none : {"one.0", "two", "two.2", "two.-1", "two.1x", "two.", "three", ""})
    CHECK(find_coordinate(m, none).joint == -1);
  CHECK(coordinate_name(m.joints[0], 0) == "one");
  CHECK(coordinate_name(m.joints[1], 1) == "two.1");
}

TEST_CASE("Cells of a table are text or numbers, never formulas") {
  CHECK(csv_field("swing") == "swing");
  CHECK(csv_field("a,b") == "\"a,b\"");
  CHECK(csv_field("say \"a\"") == "\"say \"\"a\"\"\"");
  CHECK(csv_field("two\nlines") == "\"two\nlines\"");
  CHECK(csv_field("") == "");
  for (const char* formula : {"=1+1", "+1", "-arm", "@sum", "\ttab", "\rreturn", "\nend", "  =1"})
    CHECK(csv_field(formula) == "\"'" + std::string(formula) + "\"");
  CHECK(csv_field("=a\"b") == "\"'=a\"\"b\"");
  CHECK(csv_field("a=b") == "a=b");
  CHECK(csv_field("a\x1b[2J") == "a\\x1b[2J");
  CHECK(csv_number(-0.5) == "-0.5");
  CHECK(csv_number(std::numeric_limits<double>::infinity()).empty());
  CHECK(csv_number(std::numeric_limits<double>::quiet_NaN()).empty());
}

TEST_CASE("Printed text does not steer a terminal") {
  CHECK(printable("plain ü 球 🜚") == "plain ü 球 🜚");
  CHECK(printable("\x1b]0;title\x07") == "\\x1b]0;title\\x07");
  CHECK(printable("a\nb\tc\rd") == "a\\nb\\tc\\rd");
  CHECK(printable("\x7f\xC2\x9B\xC2\x80") == "\\x7f\\x9b\\x80");
  CHECK(printable("\xE2\x80\xAE\xE2\x81\xA6") == "\\u202e\\u2066");
  CHECK(printable("a\xFF\x80z") == "a\\xff\\x80z");
  CHECK(printable("\xE7\x90") == "\\xe7\\x90");
  CHECK(printable_lines("a\nb\x1b\r") == "a\nb\\x1b\\r");
  CHECK(printable_json("{\n \"a\": \"\xC2\x9B\x7F\"\n}") == "{\n \"a\": \"\\u009b\\u007f\"\n}");
  CHECK(printable_json("[\"ü\"]") == "[\"ü\"]");
}
