#include "options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "frame_sources.h"

namespace pellucid::bench {

namespace {

std::pair<int, int> parseSize(const std::string& text) {
  int width = 0, height = 0, end = 0;
  const bool whole = std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &end) == 2 &&
                     static_cast<size_t>(end) == text.size();
  if (!whole || width < 16 || height < 16 || width > 8192 || height > 8192)
    throw CLI::ValidationError("--frame-sizes", "\"" + text + "\" is not WIDTHxHEIGHT of 16 to 8192 pixels");
  return {width, height};
}

}  // namespace

int readOptions(int argc, char** argv, Options& options) {
  CLI::App app("GPU times of Pellucid's frames, and of others', beside their errors.", "pellucid_bench");
  app.add_option("--device", options.device, "part of the Vulkan device's name");
  app.add_option("--tables", options.tables, "which sections to measure, with commas")
      ->delimiter(',')
      ->check(CLI::IsMember(std::set<std::string>{"frames", "paths", "context"}))
      ->capture_default_str();
  app.add_option("--repeat", options.repeat, "counted runs of each; default 7, on a software device 3")
      ->check(CLI::Range(1, 10000));

  FrameOptions& f = options.frames;
  app.add_option("--frames", f.captures, "captures that the section frames measures, with commas")
      ->delimiter(',');
  app.add_option(
      "--models", f.models,
      "folder of head_views.glb and crowd.glb, which the section frames draws in place of stand-ins");
  app.add_option_function<std::vector<std::string>>(
         "--frame-sizes",
         [&f](const std::vector<std::string>& texts) {
           f.sizes.clear();
           for (const std::string& text : texts) f.sizes.push_back(parseSize(text));
         },
         "WIDTHxHEIGHT of frames that are made, with commas; default 1280x720, 1920x1080, 2560x1440 and "
         "3840x2160, "
         "on a software device 256x144")
      ->delimiter(',');
  app.add_option("--frame-names", f.names, "which of the frames that are made, with commas; default all")
      ->delimiter(',')
      ->check(CLI::IsMember(std::set<std::string>(std::begin(kFrameNames), std::end(kFrameNames))));
  app.add_option("--shadow-size", f.shadowSize,
                 "texels across a shadow map of frames that are made; default 2048, on a software device 512")
      ->check(CLI::Range(16, 8192));
  app.add_option("--error-pixels", f.errorPixels, "of a frame, at most, where brute force says the error")
      ->check(CLI::Range(16, 1000000))
      ->capture_default_str();

  app.add_option("--json", options.json, "file to write, - for standard output");

  app.add_flag("--create-context", options.createContext)->group("");
  app.add_option("--uses", options.uses)->group("");
  app.add_option("--load-cache", options.loadCache)->group("");
  app.add_option("--save-cache", options.saveCache)->group("");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e);
  }
  return -1;
}

}  // namespace pellucid::bench
