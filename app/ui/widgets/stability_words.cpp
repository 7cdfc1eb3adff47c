#include "app/ui/widgets/stability_words.hpp"

#include "app/render/icons.hpp"
#include "app/session/state_words.hpp"

namespace flyball {

StabilityWords stability_words(std::optional<bool> stable, std::optional<StabilityReason> reason,
                               const UiColors& colors) {
  const char* why = reason ? reason_text(*reason) : "";
  if (stable == true) return {icon::check, "stable", why, colors.good};
  if (stable == false) return {icon::warning, "unstable", why, colors.bad};
  if (reason == StabilityReason::neutral) return {icon::check, "neutral", why, colors.good};
  if (reason == StabilityReason::gyroscopic_only) return {icon::warning, "held by spin", why, colors.warn};
  return {icon::question, "undecided", why, colors.warn};
}

} // namespace flyball
