#include "app/platform/runtime_library.hpp"

#include <dlfcn.h>

namespace flyball {

RuntimeLibrary::RuntimeLibrary(std::initializer_list<const char*> names, Which which) {
  // It stays when this goes: to load libOSMesa with LLVM again takes longer than to make a context by it.
  const int how = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE | (which == Which::loaded ? RTLD_NOLOAD : 0);
  for (const char* name : names)
    if (!handle_) handle_ = ::dlopen(name, how);
}

RuntimeLibrary::~RuntimeLibrary() {
  if (handle_) ::dlclose(handle_);
}

void* RuntimeLibrary::symbol(const char* name) const {
  return handle_ ? ::dlsym(handle_, name) : nullptr;
}

} // namespace flyball
