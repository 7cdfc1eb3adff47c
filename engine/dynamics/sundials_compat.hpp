// What differs between SUNDIALS 6 (Debian 12) and 7 (Debian 13), in one place.
#pragma once

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_version.h>

namespace flyball::sundials {

#if SUNDIALS_VERSION_MAJOR >= 7
using Real = sunrealtype;
using Boolean = sunbooleantype;

// Messages are handled by the context: by nobody, as everything is told by what functions return.
inline int create_context(SUNContext* context) {
  const int failed = SUNContext_Create(SUN_COMM_NULL, context);
  return failed != 0 ? failed : SUNContext_ClearErrHandlers(*context);
}
inline void silence_cvode(void*) {}
inline void silence_erk(void*) {}
#else
using Real = realtype;
using Boolean = booleantype;

inline int create_context(SUNContext* context) {
  return SUNContext_Create(nullptr, context);
}
inline void keep_silent(int, const char*, const char*, char*, void*) {}
inline void silence_cvode(void* memory) {
  CVodeSetErrHandlerFn(memory, keep_silent, nullptr);
}
inline void silence_erk(void* memory) {
  ERKStepSetErrHandlerFn(memory, keep_silent, nullptr);
}
#endif
static_assert(sizeof(Real) == sizeof(double));

// Since 7.1 all steppers of ARKODE share these, and their own are deprecated.
namespace erk {
#if SUNDIALS_VERSION_MAJOR > 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR >= 1)
inline constexpr auto reset = ARKodeReset;
inline constexpr auto evolve = ARKodeEvolve;
inline constexpr auto release = ARKodeFree;
inline constexpr auto init_roots = ARKodeRootInit;
inline constexpr auto set_user_data = ARKodeSetUserData;
inline constexpr auto set_weights = ARKodeWFtolerances;
inline constexpr auto set_interpolant_degree = ARKodeSetInterpolantDegree;
inline constexpr auto set_most_steps = ARKodeSetMaxNumSteps;
inline constexpr auto set_most_warnings = ARKodeSetMaxHnilWarns;
inline constexpr auto set_most_error_failures = ARKodeSetMaxErrTestFails;
inline constexpr auto set_fixed_step = ARKodeSetFixedStep;
inline constexpr auto set_postprocess = ARKodeSetPostprocessStepFn;
inline constexpr auto set_no_root_warning = ARKodeSetNoInactiveRootWarn;
inline constexpr auto set_stop_time = ARKodeSetStopTime;
inline constexpr auto roots_found = ARKodeGetRootInfo;
inline constexpr auto steps = ARKodeGetNumSteps;
inline constexpr auto error_failures = ARKodeGetNumErrTestFails;
inline constexpr auto flag_name = ARKodeGetReturnFlagName;
#else
inline constexpr auto reset = ERKStepReset;
inline constexpr auto evolve = ERKStepEvolve;
inline constexpr auto release = ERKStepFree;
inline constexpr auto init_roots = ERKStepRootInit;
inline constexpr auto set_user_data = ERKStepSetUserData;
inline constexpr auto set_weights = ERKStepWFtolerances;
inline constexpr auto set_interpolant_degree = ERKStepSetInterpolantDegree;
inline constexpr auto set_most_steps = ERKStepSetMaxNumSteps;
inline constexpr auto set_most_warnings = ERKStepSetMaxHnilWarns;
inline constexpr auto set_most_error_failures = ERKStepSetMaxErrTestFails;
inline constexpr auto set_fixed_step = ERKStepSetFixedStep;
inline constexpr auto set_postprocess = ERKStepSetPostprocessStepFn;
inline constexpr auto set_no_root_warning = ERKStepSetNoInactiveRootWarn;
inline constexpr auto set_stop_time = ERKStepSetStopTime;
inline constexpr auto roots_found = ERKStepGetRootInfo;
inline constexpr auto steps = ERKStepGetNumSteps;
inline constexpr auto error_failures = ERKStepGetNumErrTestFails;
inline constexpr auto flag_name = ERKStepGetReturnFlagName;
#endif
} // namespace erk

} // namespace flyball::sundials
