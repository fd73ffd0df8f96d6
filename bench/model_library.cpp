// pellucid_bench_models.so
#include "frame_files.h"
#include "gltf/gltf.h"

extern "C" {
void pellucidBenchReadModel(const pellucid::bench::ModelFile& file, pellucid::harness::Model& model) {
  model = pellucid::harness::loadGltf(file.path, {file.metersPerUnit, file.presets}).model;
}
}

static_assert(std::is_same_v<decltype(pellucidBenchReadModel), pellucid::bench::ReadModelFile>);
