// Triangle meshes, with rays by Embree.
#pragma once

#include <memory>

#include "raster/model.h"
#include "reference/path_tracer/trace_scene.h"

namespace pellucid::harness::reference {

// Parts of one object are one body; a part's own surface says its material. Bodies with a material must be
// closed (raster/close_mesh.h). A hit from the wrong side does not end a way through a body: what another
// translucent body, or a fold of the same one, encloses is medium, too. Faces are culled as the rasterizer
// does: first() passes back faces unless their surface is double-sided. All of the model is copied.
std::unique_ptr<TraceScene> makeMeshScene(const Model& model);

}  // namespace pellucid::harness::reference
