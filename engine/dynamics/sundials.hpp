// What the steppers share of SUNDIALS: contexts and vectors that free themselves, and what is called back.
#pragma once

#include "engine/dynamics/stepper.hpp"
#include "engine/dynamics/sundials_compat.hpp"

#include <nvector/nvector_serial.h>

#include <Eigen/Core>

#include <new>

namespace flyball::sundials {

class Context {
 public:
  Context() {
    if (create_context(&context_) != 0) throw std::bad_alloc();
  }
  ~Context() { SUNContext_Free(&context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  operator SUNContext() const { return context_; }

 private:
  SUNContext context_ = nullptr;
};

class Vector {
 public:
  Vector(int size, SUNContext context) : vector_(N_VNew_Serial(size, context)) {
    if (!vector_) throw std::bad_alloc();
    N_VEnableLinearCombination_Serial(vector_, 1); // in one pass, of those made like it, too
    N_VConst(0, vector_);
  }
  ~Vector() { N_VDestroy(vector_); }
  Vector(const Vector&) = delete;
  Vector& operator=(const Vector&) = delete;
  operator N_Vector() const { return vector_; }
  double* data() const { return N_VGetArrayPointer(vector_); }
  Eigen::Map<Eigen::VectorXd> view() const { return {data(), N_VGetLength(vector_)}; }

 private:
  N_Vector vector_;
};

inline double* data(N_Vector v) {
  return N_VGetArrayPointer(v);
}

// The functions that an integrator calls back; what they are given to know it by is the Ode.
inline Ode& ode_of(void* ode) {
  return *static_cast<Ode*>(ode);
}

// To be tried again with a shorter step, or given up.
inline int failure(const Ode& ode) {
  return ode.wanted() ? 1 : -1;
}

inline int rate(Real t, N_Vector y, N_Vector out, void* data_of_user) {
  Ode& ode = ode_of(data_of_user);
  return ode.rate(t, data(y), data(out)) ? 0 : failure(ode);
}

inline int weights(N_Vector y, N_Vector out, void* ode) {
  ode_of(ode).weights(data(y), data(out));
  double* w = data(out);
  for (sunindextype i = 0; i < N_VGetLength(out); ++i)
    w[i] = 1 / w[i];
  return 0;
}

inline int event_values(Real t, N_Vector y, Real* out, void* ode) {
  ode_of(ode).event_values(t, data(y), out);
  return 0;
}

} // namespace flyball::sundials
