// Procedural scenes, exact.
#pragma once

#include <memory>

#include "reference/path_tracer/trace_scene.h"
#include "scene/model.h"

namespace pellucid::harness::reference {

// Each object is a body; where objects overlap, a way through one goes on in the other, with the medium it
// began in. The model must outlive the scene.
std::unique_ptr<TraceScene> makeSolidScene(const SceneModel& model);

}  // namespace pellucid::harness::reference
