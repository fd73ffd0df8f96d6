// The boundary of the C API.
#pragma once

#include <string>

#include "describe.h"
#include "pellucid/pellucid_material.h"

namespace pellucid::material {

// Refuses a NULL. `name`: the argument's.
inline void require(const char* name, const void* given) {
  if (given == nullptr) throw Refusal(name, "NULL");
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
