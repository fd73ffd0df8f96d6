// The diffusion profile of a compiled material.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pellucid/pellucid.h"
#include "reference/profile.h"

namespace pellucid::harness::reference {

// Where R(r) comes from.
enum class ProfileSource {
  Material,  // Burley in channels with burleyDistance > 0, else the Gaussians
  Burley,    // burleyDistance; 0: the channel does not diffuse
  Gaussians,
  Table  // ProfileValues
};

// R(r) measured at `radius` (mm), RGB per radius; any scale.
struct ProfileValues {
  std::vector<double> radius;
  std::vector<std::array<double, 3>> value;
};

// One channel's profile; nothing if the channel does not diffuse. `table` is read for
// ProfileSource::Table only. Throws InputError naming the field for values no profile can have.
std::optional<Profile> channelProfile(const PellucidMaterial& material, int channel, ProfileSource source,
                                      const ProfileValues& table);

}  // namespace pellucid::harness::reference
