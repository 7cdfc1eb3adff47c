// Sections of the results, one file each.
#pragma once

namespace flyball {

struct Floquet;
struct Session;
struct ToolState;
struct Ui;

// Which are open.
struct ResultSections {
  bool torques = true, reactions = false, springs = false, eigenvalues = false, system = false;
  bool coordinates = false; // all of many
};

void coordinate_results(Session& session, Ui& ui, ResultSections& open);
void measure_results(Session& session, Ui& ui);
// Of a mechanism with friction: its band, and what holding takes.
void friction_results(const Session& session, Ui& ui);
// Where a drive makes the balance turn: the motion in its place.
void periodic_results(Session& session, Ui& ui, ResultSections& open);
// Where the steady state hunts: the limit cycle beside it can be asked for, and is told.
void cycle_offer(Session& session, Ui& ui);
void cycle_results(Session& session, Ui& ui, ResultSections& open);
void floquet_rows(Ui& ui, const Floquet& floquet);
void solver_results(const Session& session, Ui& ui);
// While a hand pulls.
void pull_results(const Session& session, Ui& ui, const ToolState& tool);
// Position, speed and acceleration of the selected bodies.
void body_results(Session& session, Ui& ui);
// Drive torques, reactions.
void load_results(const Session& session, Ui& ui, ResultSections& open);
void eigenvalue_results(const Session& session, Ui& ui, ResultSections& open);
void system_results(const Session& session, Ui& ui, ResultSections& open);
// The residual after each iteration, on a logarithmic scale.
void history_plot(const Session& session, Ui& ui, float width, float height);

} // namespace flyball
