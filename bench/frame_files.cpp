#include "frame_files.h"

#include <dlfcn.h>

#include "common/error.h"

namespace pellucid::bench {

namespace {

// Never unloaded: what it returned may live on.
template <class Function>
Function* find(const char* library, const char* name) {
  const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe").parent_path() / library;
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle)
    throw harness::InputError(path.string(), "",
                              std::string("cannot be loaded, and without it no such file can be read: ") +
                                  dlerror() + "; the build makes it where PELLUCID_BUILD_HARNESS is on");
  void* symbol = dlsym(handle, name);
  if (!symbol)
    throw harness::InputError(path.string(), name,
                              "is not in it: it is of another build than pellucid_bench");
  return reinterpret_cast<Function*>(symbol);
}

}  // namespace

harness::Capture readCaptureFile(const std::filesystem::path& file) {
  harness::Capture capture;
  find<ReadCaptureFile>(kCaptureLibrary, kReadCaptureFile)(file, capture);
  return capture;
}

harness::Model readModelFile(const ModelFile& file) {
  harness::Model model;
  find<ReadModelFile>(kModelLibrary, kReadModelFile)(file, model);
  return model;
}

}  // namespace pellucid::bench
