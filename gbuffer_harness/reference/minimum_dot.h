// Whelan 2009, 4.6.2: the minimum dot of a light from a table by where the light is around the object.
#pragma once

#include "capture/capture.h"
#include "common/translucency_settings.h"

namespace pellucid::harness::reference {

// settings.minimumDot for models without a table. Throws InputError when the table does not fit the model.
double minimumDot(const TranslucencySettings& settings, const Light& light);

}  // namespace pellucid::harness::reference
