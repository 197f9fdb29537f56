// Directions as a surgeon says them, of the patient: where something is drawn, where it has been drawn to.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::training {

struct PatientDirection {
  std::string_view word;
  Vec3d way;  ///< any length
};
inline constexpr std::array<PatientDirection, 8> kPatientDirections{{{"feet", {0, -1, 0}},
                                                                     {"head", {0, 1, 0}},
                                                                     {"up", {0, 0, 1}},
                                                                     {"down", {0, 0, -1}},
                                                                     {"left", {1, 0, 0}},
                                                                     {"right", {-1, 0, 0}},
                                                                     {"right_hip", {-1, -1, 0}},
                                                                     {"left_shoulder", {1, 1, 0}}}};

/// Of one metre; towards the feet where the word is none of these.
inline Vec3d patient_direction(std::string_view word) {
  for (const PatientDirection& d : kPatientDirections)
    if (d.word == word) return normalised(d.way);
  return kPatientDirections.front().way;
}
/// All words.
inline std::vector<std::string> patient_directions() {
  std::vector<std::string> words;
  for (const PatientDirection& d : kPatientDirections) words.emplace_back(d.word);
  return words;
}

}  // namespace trocar::training
