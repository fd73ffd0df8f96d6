// `pellucid sheet`: results side by side in one picture, under one exposure.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "capture/exr.h"
#include "cli/commands.h"
#include "common/error.h"
#include "common/png.h"

namespace pellucid::harness {
namespace {

struct Options {
  std::vector<std::string> inputs;
  std::string output;
  int columns = 3;
  float exposure = 0;
};

void sheet(const Options& options) {
  std::vector<Image> images;
  std::vector<const Image*> pointers;
  images.reserve(options.inputs.size());
  for (const std::string& input : options.inputs) {
    images.push_back(readExrImage(input));
    const Image &image = images.back(), &first = images.front();
    if (image.width != first.width || image.height != first.height)
      throw InputError(input, "",
                       "is " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                           " and \"" + options.inputs.front() + "\" " + std::to_string(first.width) + " x " +
                           std::to_string(first.height));
    pointers.push_back(&image);
  }
  const Image picture = contactSheet(pointers, options.columns);
  // One exposure for all: brightness is part of what is compared.
  const float exposure = options.exposure > 0 ? options.exposure : autoExposure(picture);
  writePng(options.output, picture.width, picture.height, toSrgb(picture, exposure));
  std::printf("wrote %s (%zu images, exposure %g)\n", options.output.c_str(), images.size(),
              static_cast<double>(exposure));
}

}  // namespace

void addSheetCommand(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("sheet", "Lay EXR images out in one PNG, under one exposure");
  command->add_option("images", options->inputs, "EXR files of one size")->required();
  command->add_option("-o,--output", options->output, "PNG to write")->required();
  command->add_option("--columns", options->columns, "images a row")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--exposure", options->exposure, "default: from the pictures")
      ->check(CLI::PositiveNumber);
  command->callback([options] { sheet(*options); });
}

}  // namespace pellucid::harness
