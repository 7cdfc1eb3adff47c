// A library of the system's, loaded at run time and kept until the process ends.
#pragma once

#include <initializer_list>

namespace flyball {

class RuntimeLibrary {
 public:
  enum class Which { any, loaded };
  // The first of these names that is there, or that this process has loaded already.
  explicit RuntimeLibrary(std::initializer_list<const char*> names, Which which = Which::any);
  ~RuntimeLibrary();
  RuntimeLibrary(const RuntimeLibrary&) = delete;
  RuntimeLibrary& operator=(const RuntimeLibrary&) = delete;

  explicit operator bool() const { return handle_ != nullptr; }
  // Null where it has none of that name.
  template <typename Function>
  Function find(const char* name) const {
    return reinterpret_cast<Function>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  void* handle_ = nullptr;
};

} // namespace flyball
