// Objects that frames share in turns, so that a frame need not make what an earlier one has made.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/gpu_image.h"

namespace pellucid::harness {

template <class Key, class T>
class Pool {
public:
  // An object of that key that nobody holds, or make(), a std::shared_ptr<T>. Objects keep what they hold.
  template <class Make>
  std::shared_ptr<T> take(const Key& key, const Make& make) {
    for (Entry& entry : entries_)
      if (entry.object.use_count() == 1 && entry.key == key) {
        entry.idleFrames = 0;
        return entry.object;
      }
    entries_.push_back({key, make(), 0});
    return entries_.back().object;
  }

  // Between frames: destroys what nobody held for three of them.
  void nextFrame() {
    constexpr int kMostIdleFrames = 2;
    for (Entry& entry : entries_) entry.idleFrames = entry.object.use_count() == 1 ? entry.idleFrames + 1 : 0;
    std::erase_if(entries_, [](const Entry& entry) { return entry.idleFrames > kMostIdleFrames; });
  }

private:
  struct Entry {
    Key key;
    std::shared_ptr<T> object;
    int idleFrames;
  };
  std::vector<Entry> entries_;
};

// Images for all uses of GpuImage, in VK_IMAGE_LAYOUT_GENERAL. New ones hold 0.
class ImagePool {
public:
  explicit ImagePool(Device& device) : device_(device) {}

  std::shared_ptr<GpuImage> take(int width, int height, VkFormat format) {
    return pool_.take({width, height, format}, [&] {
      auto image = std::make_shared<GpuImage>(device_, width, height, format);
      image->clear();
      return image;
    });
  }
  void nextFrame() { pool_.nextFrame(); }

private:
  struct Key {
    int width, height;
    VkFormat format;
    bool operator==(const Key&) const = default;
  };
  Device& device_;
  Pool<Key, GpuImage> pool_;
};

}  // namespace pellucid::harness
