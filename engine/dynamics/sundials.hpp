// What the steppers share of SUNDIALS: contexts and vectors that free themselves.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>

#include <Eigen/Core>

#include <new>

namespace flyball::sundials {

static_assert(sizeof(realtype) == sizeof(double));

class Context {
 public:
  Context() {
    if (SUNContext_Create(nullptr, &context_) != 0) throw std::bad_alloc();
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

} // namespace flyball::sundials
