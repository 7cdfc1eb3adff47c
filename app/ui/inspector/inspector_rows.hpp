// What inspectors are made of: rows with a label and something to edit. Edits wait until the panels are drawn
// (see typed_field.hpp).
#pragma once

#include "app/ui/widgets/quantity_field.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace flyball {

// The parts that are edited with one: those that are drawn together where it is the first of them, see
// FieldState; else itself.
std::vector<std::string> edited_with(const Ui& ui, const Part& part);
// Those of them beside itself, of the mechanism as it is.
std::vector<const Body*> others_edited(const Session& session, const Ui& ui, const Body& body);
std::vector<const Joint*> others_edited(const Session& session, const Ui& ui, const Joint& joint);
std::vector<const Force*> others_edited(const Session& session, const Ui& ui, const Force& force);
// Whether several are.
bool is_of_several(const Ui& ui);

// Edits the part of that name and those that are edited with it, wherever they are by then; nothing where
// they are gone.
void edit_body(Session& session, Ui& ui, const std::string& step, const std::string& name,
               std::function<void(Body&)> change);
void edit_joint(Session& session, Ui& ui, const std::string& step, const std::string& name,
                std::function<void(Joint&)> change);
void edit_force(Session& session, Ui& ui, const std::string& step, const std::string& name,
                std::function<void(Force&)> change);
void edit_later(Session& session, Ui& ui, const std::string& step,
                std::function<void(Mechanism&, Selection&)> change);
// Takes out sliders of numbers that `before` had and `mechanism` has not.
void drop_lost_sliders(const Mechanism& before, Mechanism& mechanism);

// A number of the part that is drawn: what is typed is given to all that are edited with it, and "various"
// stands where they differ. Nothing is drawn where one of them has no such number.
void number_row(Session& session, Ui& ui, const std::string& label, QuantityField field,
                const std::function<void()>& reset = {});
// The same of a field that is drawn by itself; false where there is nothing to be drawn.
bool edit_together(const Session& session, const Ui& ui, QuantityField& field);

// A part of an inspector that opens and closes, and remembers it.
bool inspector_section(const Session& session, Ui& ui, const std::string& name, const char* title, bool open);

// The label; what follows stands beside it. Returns the width for it (without the margin).
float row_label(const Ui& ui, const std::string& label, const char* help = nullptr);
// With references following; says in place why a name cannot be taken.
void name_row(Session& session, Ui& ui, const Part& part);
// A field in which the part is given another name; whether it is being typed in.
bool name_field(Session& session, Ui& ui, const std::string& widget, const Part& part, float width);
void text_row(Session& session, Ui& ui, const std::string& name, const std::string& label,
              const std::string& text, const char* help, const std::function<void(const std::string&)>& take);
// One of several words; the new one where another was chosen, any where the parts have `various` ones.
std::optional<std::size_t> choice_row(Ui& ui, const std::string& name, const std::string& label,
                                      std::span<const std::string_view> options, std::size_t chosen,
                                      const char* help, bool various = false);
// One of a few words that stand side by side; the new one where another was chosen. None is lit where
// the parts have various ones.
struct SideOption {
  const char *name, *title, *help; // `name` of the widget, after the row's
  const char* refused = nullptr;   // why it cannot be chosen
};
std::optional<std::size_t> side_by_side_row(Ui& ui, const std::string& name, const std::string& label,
                                            std::span<const SideOption> options,
                                            std::optional<std::size_t> chosen, const char* help);
// One of many names, searchable where there are very many.
std::optional<std::string> name_choice_row(Ui& ui, const std::string& name, const std::string& label,
                                           std::span<const std::string> options, const std::string& chosen,
                                           const char* help);
// One of the numbers at these addresses, which are asked for while the list is open, by their phrases
// (number_phrase()); returns an address. `chosen` is what stands there.
std::optional<std::string> number_choice_row(const Mechanism& mechanism, Ui& ui, const std::string& name,
                                             const std::string& label,
                                             const std::function<std::vector<std::string>()>& addresses,
                                             const std::string& chosen, const char* help);
// A tick, or a bar where it is `mixed` among several parts; `refused` says why it cannot be set. Returns
// whether it was clicked.
bool check_row(Ui& ui, const std::string& name, const std::string& label, bool on, const char* help,
               const char* refused = nullptr, bool mixed = false);
// Three numbers, each its own row.
struct VectorField {
  std::string name; // of the widgets: "inspector/at" has "inspector/at/x"
  Vec3 value = Vec3::Zero();
  std::string unit{}, help{};
  std::string address{};    // of the vector
  std::string expression{}; // where those of its numbers are kept, if it has no address
  std::function<void(int, double)> set{};
  bool standard = false;
  std::function<void(const Mechanism&, Mechanism&)> follow{}; // see QuantityField
};
void vector_rows(Session& session, Ui& ui, const std::string& label, const VectorField& field,
                 const std::function<void()>& reset = {});

// The bodies' names, after the ground's where it may be chosen.
std::vector<std::string> body_choices(const Mechanism& mechanism, bool ground);
// What a bearing's two bodies are to it.
inline constexpr const char* bearing_in_help = "The body that the bearing is in, which keeps its axes.";
inline constexpr const char* bearing_holds_help = "The body that it holds, on which its force is told.";
// One of the two bodies of a joint, spring or bearing; beside the second a button that swaps them. The ends
// of both stay on their bodies. Without a help that of a joint or spring.
void body_end_row(Session& session, Ui& ui, const Part& part, const std::array<std::string, 2>& bodies,
                  std::size_t end, const char* label, const char* help = nullptr);
// The point of that end, of a distance joint or spring.
void end_point_rows(Session& session, Ui& ui, const Part& part, const std::array<Vec3, 2>& points,
                    std::size_t end);

inline constexpr std::array<const char*, 3> axis_letters{"x", "y", "z"};

} // namespace flyball
