#include "app/platform/runtime_library.hpp"

namespace flyball {

RuntimeLibrary::RuntimeLibrary(std::initializer_list<const char*>, Which) {}
RuntimeLibrary::~RuntimeLibrary() = default;

void* RuntimeLibrary::symbol(const char*) const {
  return nullptr;
}

} // namespace flyball
