// The sliders, what a person explores with, in groups, with what the pinned ones move.
#pragma once

#include "app/session/parameter_list.hpp"
#include "app/ui/widgets/shown_rate.hpp"

namespace flyball {

struct PanelRect;
struct Session;
struct Ui;

class ParametersPanel {
 public:
  // Returns the height that it needs (points); 0 where there are no sliders.
  float draw(Session& session, Ui& ui, const PanelRect& rect);
  // So that a slider of the group can be seen.
  void open_group(ParameterGroup group);
  const ShownRates& rates() const { return rates_; }

 private:
  void draw_group(Session& session, Ui& ui, ParameterGroup which, const char* name, const char* title,
                  bool& open);

  bool pinned_ = true, named_ = true, springs_ = true, drives_ = true, dampers_ = true; // are open
  ShownRates rates_;
};

} // namespace flyball
