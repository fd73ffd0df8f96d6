// The boundary of the C API.
#pragma once

#include <string>

#include "describe.h"
#include "pellucid/pellucid_material.h"

namespace pellucid::material {

// Refuses a NULL, and a struct of another version. `name`: the argument's.
template <class Struct>
void requireStruct(const char* name, const Struct* given) {
  if (given == nullptr) throw Refusal(name, "NULL");
  if (given->structSize != sizeof(Struct))
    throw Refusal(
        "structSize",
        std::to_string(given->structSize) + " is not this library's " + std::to_string(sizeof(Struct)),
        PELLUCID_ERROR_VERSION);
}

// Runs `body` and turns what it throws into a result code and a message.
template <class Body>
PellucidResult guarded(PellucidMessageFn message, void* user, Body&& body) noexcept {
  try {
    body();
    return PELLUCID_OK;
  } catch (const Refusal& refusal) {
    if (message != nullptr)
      message(user, PELLUCID_SEVERITY_ERROR, refusal.field.c_str(), refusal.sentence.c_str());
    return refusal.result;
  } catch (...) {
    if (message != nullptr) message(user, PELLUCID_SEVERITY_ERROR, "", "out of memory");
    return PELLUCID_ERROR_OUT_OF_MEMORY;
  }
}

}  // namespace pellucid::material
