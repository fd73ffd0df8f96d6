/* The headers are C: compiled as such, linked without any Vulkan loader. */
#include <pellucid/pellucid.h>
#include <pellucid/pellucid_material.h>
#include <pellucid/pellucid_plan.h>
#include <pellucid/pellucid_thesis.h>
#include <pellucid/pellucid_views.h>
#include <string.h>

int main(void) {
  PellucidMaterialDesc desc;
  PellucidMaterial material;
  PellucidFrame frame;
  PellucidThesisOptions thesis;
  PellucidContextDesc context;
  PellucidContext* none;
  static PellucidPlan plan;
  pellucidInitMaterialDesc(&desc);
  desc.kind = PELLUCID_MATERIAL_PRESET;
  desc.preset = "skin1";
  if (pellucidCompileMaterial(&desc, &material, NULL, NULL, NULL) != PELLUCID_OK) return 1;
  pellucidInitThesisOptions(&thesis);
  pellucidInitFrame(&frame);
  frame.options.gatherSamples = 16;
  frame.options.thesis = &thesis;
  frame.materialCount = 1;
  frame.materials = &material;
  /* No extent and no projection yet: refused. */
  if (pellucidBuildPlan(&frame, NULL, &plan) != PELLUCID_ERROR_INVALID_ARGUMENT) return 2;
  frame.imageExtent[0] = frame.imageExtent[1] = 64;
  frame.clipFromView[0] = 1;
  frame.clipFromView[5] = frame.clipFromView[11] = -1;
  frame.clipFromView[14] = 0.1f;
  if (pellucidBuildPlan(&frame, NULL, &plan) != PELLUCID_OK) return 3;
  if (strcmp(plan.dispatches[0].name, "base level") != 0) return 4;
  /* No context and no device yet: refused. */
  if (pellucidRecordViews(NULL, VK_NULL_HANDLE, 0, NULL) != PELLUCID_ERROR_INVALID_ARGUMENT) return 6;
  pellucidInitContextDesc(&context);
  return pellucidCreateContext(&context, &none) == PELLUCID_ERROR_INVALID_ARGUMENT ? 0 : 5;
}
