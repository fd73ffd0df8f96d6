// The perception test of Whelan 2009, 3.4.1: people choose the color of the light that comes through.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace pellucid::harness {

// A row of the answers' file: participant,scene,red,green,blue,seconds.
struct PerceptionAnswer {
  std::string participant, scene;
  std::array<double, 3> color;  // of options.thesis->transmittanceFilter, 0..1
  double seconds = 0;           // from the scene's first frame on
};

// One capture a line, relative to the list; empty lines and those that begin with # say nothing. Throws
// InputError for a list that cannot be read or names none.
std::vector<std::filesystem::path> readSceneList(const std::filesystem::path& list);

// Throws InputError naming file, line and value. A file that is not there has no answers.
std::vector<PerceptionAnswer> readAnswers(const std::filesystem::path& csv);

// Adds a row, and the header to a new file. Throws InputError where it cannot be written.
void addAnswer(const std::filesystem::path& csv, const PerceptionAnswer& answer);

// Throws InputError for a name that a row cannot hold, and for a participant who is in the file already.
void requireNewParticipant(const std::filesystem::path& csv, const std::string& participant);

}  // namespace pellucid::harness
