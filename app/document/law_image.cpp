#include "app/document/law_image.hpp"

#include "app/document/named_edits.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>

namespace flyball {
namespace {

class LawImage {
 public:
  LawImage(const Mechanism& before, const Isometry& isometry, const CopiedNames& copies, Mechanism& mechanism)
      : before_(before), isometry_(isometry), copies_(copies), mechanism_(mechanism) {}

  std::string write(std::string text) {
    text = parts_renamed_in(text, ResultPart::joint, copies_.joint);
    text = parts_renamed_in(text, ResultPart::force, copies_.force);
    const Expression law(text, Expression::Results::allowed);
    for (auto call = law.results().rbegin(); call != law.results().rend(); ++call) {
      if (argument_kind(result_function(call->result), call->arguments.size()) != ArgumentKind::point)
        continue;
      const auto copied = [&](const ResultCall::Argument& of) { return copies_.body(of.name) != of.name; };
      if (std::ranges::none_of(call->arguments, copied)) continue;
      const ResultCall::Argument& last = call->arguments.back();
      const std::size_t end = text.find(')', std::max(last.begin + last.length, last.point_begin)) + 1;
      text.replace(call->begin, end - call->begin, image_of_call(*call));
    }
    return text;
  }

 private:
  std::string image_of_call(const ResultCall& call) {
    std::string arguments;
    for (const ResultCall::Argument& of : call.arguments)
      arguments += (arguments.empty() ? "" : ", ") + image_of_argument(of);
    const Result result = call.result;
    if (result > Result::az || result < Result::x)
      return std::string(result_function(result).name) + "(" + arguments + ")";
    // n . p = (R n) . (p' - t) of p' = R p + t, and of vectors without t.
    const auto first = static_cast<int>(result < Result::vx   ? Result::x
                                        : result < Result::ax ? Result::vx
                                                              : Result::ax);
    const Vec3 n = isometry_.vector(Vec3::Unit(static_cast<int>(result) - first));
    std::string out;
    for (int i = 0; i < 3; ++i) {
      if (std::abs(n[i]) < rounding) continue;
      const std::string component =
          std::string(result_function(static_cast<Result>(first + i)).name) + "(" + arguments + ")";
      const std::string size =
          std::abs(std::abs(n[i]) - 1) < rounding ? "" : number_text(std::abs(n[i])) + "*";
      out += (n[i] < 0 ? (out.empty() ? "-" : " - ") : (out.empty() ? "" : " + ")) + size + component;
    }
    const double shift = n.dot(isometry_.shift);
    if (result <= Result::z && std::abs(shift) > rounding)
      out += (shift < 0 ? " + " : " - ") + number_text(std::abs(shift)) + " m";
    return out.find(' ') == std::string::npos && !out.starts_with('-') ? out : "(" + out + ")";
  }

  std::string image_of_argument(const ResultCall::Argument& of) {
    const std::string copy = copies_.body(of.name), body = argument_text(copy);
    if (of.point.empty()) return body;
    const bool moves = copy != of.name || of.name == ground_name;
    return body + "@" + (moves ? image_of_point(of.point) : of.point);
  }

  std::string image_of_point(const std::string& name) {
    const auto point = std::ranges::find(before_.points, name, &NamedPoint::name);
    if (point == before_.points.end()) return name;
    const Vec3 at = isometry_.point(point->at);
    if (at.isApprox(point->at, rounding)) return name;
    const auto there = std::ranges::find_if(mechanism_.points, [&](const NamedPoint& each) {
      return each.name.starts_with(name) && each.at == at;
    });
    if (there != mechanism_.points.end()) return there->name;
    mechanism_.points.push_back({free_name(mechanism_, name), at});
    return mechanism_.points.back().name;
  }

  static constexpr double rounding = 1e-12;

  const Mechanism& before_;
  const Isometry& isometry_;
  const CopiedNames& copies_;
  Mechanism& mechanism_;
};

} // namespace

std::string law_image(const Mechanism& before, std::string_view law, const Isometry& isometry,
                      const CopiedNames& copies, Mechanism& mechanism) {
  try {
    return LawImage(before, isometry, copies, mechanism).write(with_measures(before, law));
  } catch (const ExpressionError&) {
    return std::string(law);
  }
}

} // namespace flyball
