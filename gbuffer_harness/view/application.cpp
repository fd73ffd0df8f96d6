#include "view/application.h"

#include <imgui.h>
#include <algorithm>
#include <optional>

#include "capture/exr.h"
#include "capture/read.h"
#include "capture/write.h"
#include "common/error.h"
#include "common/image.h"
#include "common/png.h"
#include "common/whole_file.h"
#include "view/frames.h"
#include "view/gui.h"
#include "view/input.h"
#include "view/panel.h"
#include "window/window.h"

namespace pellucid::harness {

namespace {

// The files beside a saved capture NAME.exr, whose replay with the settings gives the result bit for bit.
struct SavedFiles {
  std::filesystem::path capture, settings, result, picture;
};

// Throws InputError for another extension than .exr.
SavedFiles savedFiles(const std::filesystem::path& capture) {
  if (capture.extension() != ".exr" || capture.stem().empty())
    throw InputError(capture.string(), "", "captures are saved as .exr");
  const auto beside = [&](const char* extension) {
    return std::filesystem::path(capture).replace_extension(extension);
  };
  return {capture, beside(".settings.json"), beside(".pellucid.exr"), beside(".png")};
}

bool isDown(unsigned char key) { return ImGui::GetIO().KeysDown[key]; }

// Dear ImGui shows what a click did in the frames after it.
constexpr int kFramesAfterInput = 3;
constexpr VkFormat kScreenFormat = VK_FORMAT_R8G8B8A8_UNORM;

DeviceOptions deviceOptions(const ApplicationOptions& options, const Desktop* desktop) {
  DeviceOptions result{options.device, options.validation};
  if (desktop) desktop->require(result);
  return result;
}

// The screen as an image, which the window shows and screenshots are made of.
std::unique_ptr<RenderTarget> makeScreen(Device& device, int width, int height) {
  const VkClearColorValue gray{.float32 = {0.08f, 0.08f, 0.09f, 1}};
  return std::make_unique<RenderTarget>(device, RenderTarget::Shape{width, height, {{kScreenFormat, gray}}});
}

class Application {
public:
  explicit Application(const ApplicationOptions& options)
      : options_(options),
        desktop_(options.window ? std::make_unique<Desktop>() : nullptr),
        device_(deviceOptions(options, desktop_.get())),
        width_(options.width),
        height_(options.height) {
    if (!device_.canDraw())
      throw DeviceError(device_.description() + " computes but has no queue that draws");
    if (options.window) window_ = std::make_unique<Window>(*desktop_, device_, "Pellucid", width_, height_);
    screen_ = makeScreen(device_, width_, height_);
    gui_ = std::make_unique<Gui>(device_, *screen_, window_ ? window_->handle() : nullptr);
    display_ = std::make_unique<DisplayPass>(device_, *screen_);
    contexts_ = std::make_unique<Contexts>(device_);
    open(options.scene);
  }

  ApplicationReport run() {
    int left = kFramesAfterInput;
    while (!done()) {
      if (window_) {
        const bool idle = left == 0 && options_.frames == 0;
        window_->events(idle);
        if (idle) left = kFramesAfterInput;
      }
      if (!fitScreen()) {
        // Nothing to draw on until the window is restored; frames that were asked for end all the same.
        if (options_.frames == 0 && window_) window_->events(true);
        ++passed_;
        continue;
      }
      left = drawFrame() ? kFramesAfterInput : std::max(left - 1, 0);
    }
    if (!options_.save.empty()) save(options_.save);
    if (!options_.screenshot.empty()) screenshot(options_.screenshot);
    const std::vector<std::string> messages = device_.validationMessages();
    if (!messages.empty())
      throw DeviceError(std::to_string(messages.size()) +
                        " messages of the validation layers: " + messages.front());
    report_.device = device_.description();
    report_.recorded = frames_->recorded();
    return report_;
  }

private:
  bool done() const {
    if (window_ && window_->shouldClose()) return true;
    return options_.frames > 0 && passed_ >= options_.frames;
  }

  // Makes the screen as large as the window; false: there is none to see.
  bool fitScreen() {
    int width = width_, height = height_;
    if (window_) window_->size(width, height);
    if (width <= 0 || height <= 0) return false;
    if (width == width_ && height == height_) return true;
    width_ = width;
    height_ = height;
    screen_ = makeScreen(device_, width, height);
    return true;
  }

  ScreenRect pictureArea() const {
    return {0, 0, std::max(static_cast<float>(width_) - kPanelWidth, 1.0f), static_cast<float>(height_)};
  }

  ScreenRect picture() const {
    return fitted(pictureArea(), frames_->outline().width, frames_->outline().height);
  }

  // One frame of the screen; true where another one has to follow.
  bool drawFrame() {
    ++passed_;
    ++report_.frames;
    gui_->poll(width_, height_);
    Changes changes;
    ImGui::NewFrame();
    changes.add(controls_.apply(state_, input(), *source_, picture()));
    changes.add(drawPanel(state_, panel_, *frames_, *source_,
                          {0, 0, static_cast<float>(width_), static_cast<float>(height_)}));
    followWindow(changes);
    update(changes);
    const ScreenRect picture = this->picture();
    const ImVec2 cursor = ImGui::GetIO().MousePos;
    drawOverlay(state_, panel_, *frames_, picture, cursor.x, cursor.y);
    ImGui::Render();
    device_.run([&](VkCommandBuffer commandBuffer) {
      screen_->begin(commandBuffer);
      display_->draw(commandBuffer, *frames_, state_.display, picture, panel_.colors);
      gui_->record(commandBuffer);
      screen_->end(commandBuffer);
    });
    bool again = changes.any();
    if (window_ && !window_->present(screen_->image(0), width_, height_)) again = true;
    if (panel_.save) save(panel_.savePath);
    panel_.save = false;
    return again;
  }

  void update(const Changes& changes) {
    if (!changes.any()) return;
    try {
      frames_->update(state_, changes);
      if (panel_.isError) panel_.message.clear();
      panel_.isError = false;
    } catch (const InputError& error) {
      report(error.what(), true);
    }
    panel_.colors = falseColorsOf(state_.display, *frames_);
  }

  void report(const std::string& message, bool isError) {
    panel_.message = message;
    panel_.isError = isError;
  }

  void followWindow(Changes& changes) {
    if (!panel_.followWindow) return;
    const ScreenRect area = pictureArea();
    const int width = std::clamp(static_cast<int>(area.width), 1, kLargestSide);
    const int height = std::clamp(static_cast<int>(area.height), 1, kLargestSide);
    if (width == state_.width && height == state_.height) return;
    state_.width = width;
    state_.height = height;
    changes.scene = true;
  }

  static ViewInput input() {
    const ImGuiIO& io = ImGui::GetIO();
    ViewInput result;
    result.x = io.MousePos.x;
    result.y = io.MousePos.y;
    if (!io.WantCaptureMouse) {
      result.movedX = io.MouseDelta.x;
      result.movedY = io.MouseDelta.y;
      result.wheel = io.MouseWheel;
      result.left = io.MouseDown[0];
      result.right = io.MouseDown[1];
      result.middle = io.MouseDown[2];
      result.shift = io.KeyShift;
    }
    if (io.WantCaptureKeyboard) return result;
    result.forward = isDown('W');
    result.back = isDown('S');
    result.stepLeft = isDown('A');
    result.stepRight = isDown('D');
    result.up = isDown('E');
    result.down = isDown('Q');
    result.seconds = std::min(io.DeltaTime, 0.1f);  // a slow frame is no leap
    return result;
  }

  void open(const SceneToView& scene);
  void save(const std::filesystem::path& capture);
  void screenshot(const std::filesystem::path& file);

  const ApplicationOptions& options_;
  std::unique_ptr<Desktop> desktop_;
  Device device_;
  int width_, height_;
  std::unique_ptr<Source> source_;
  ViewState state_;
  PanelState panel_;
  Controls controls_;
  std::unique_ptr<Window> window_;
  std::unique_ptr<RenderTarget> screen_;
  std::unique_ptr<Gui> gui_;
  std::unique_ptr<DisplayPass> display_;
  std::unique_ptr<Contexts> contexts_;
  std::unique_ptr<ViewFrames> frames_;
  int passed_ = 0;  // frames, with those that had no screen
  ApplicationReport report_;
};

void Application::open(const SceneToView& scene) {
  std::unique_ptr<Source> source = scene.open(device_);
  ViewState state = source->start();
  scene.start(state);
  auto frames = std::make_unique<ViewFrames>(device_, *contexts_, *source);
  frames->update(state, {});
  if (state.display.exposure == 0) state.display.exposure = autoExposure(frames->image(Shown::After));
  frames_ = std::move(frames);
  source_ = std::move(source);
  state_ = std::move(state);
  panel_.colors = falseColorsOf(state_.display, *frames_);
}

void Application::save(const std::filesystem::path& capture) {
  try {
    const SavedFiles files = savedFiles(capture);
    // A replay is a frame of its own: what is saved must not come from frames before.
    if (state_.settings.reuse != PELLUCID_REUSE_NONE) {
      frames_->forgetHistory();
      frames_->update(state_, {.frame = true});
    }
    writeWhole(files.capture, [&](const auto& file) { writeCapture(frames_->capture(), file); });
    writeWholeText(files.settings, options_.settingsText(settingsFor(state_, Shown::After)));
    writeWhole(files.result, [&](const auto& file) {
      writeExr(file, frames_->image(Shown::After), {"R", "G", "B"}, {});
    });
    savePicture(files.picture, screen_->image(0).download());
    for (const auto& file : {files.capture, files.settings, files.result, files.picture})
      report_.saved.push_back(file.string());
    report("saved " + files.capture.string(), false);
  } catch (const InputError& error) {
    if (options_.frames > 0) throw;  // nobody reads the panel
    report(error.what(), true);
  }
}

void Application::screenshot(const std::filesystem::path& file) {
  savePicture(file, screen_->image(0).download());
  report_.saved.push_back(file.string());
}

}  // namespace

ApplicationReport runApplication(const ApplicationOptions& options) { return Application(options).run(); }

}  // namespace pellucid::harness
