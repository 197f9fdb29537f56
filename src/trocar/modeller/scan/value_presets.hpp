// Ranges of Hounsfield units to begin Threshold and Grow with. All limits are our estimate for contrast-enhanced CT in
// the portal venous phase; they overlap, as tissues do.
#pragma once

#include <array>

namespace trocar::modeller {

struct ValuePreset {
  const char* name;
  double from, to;  ///< [HU]
};
inline constexpr std::array<ValuePreset, 7> kValuePresets{{{"Air", -1024, -400},
                                                           {"Fat", -150, -30},
                                                           {"Soft tissue", 0, 180},
                                                           {"Liver", 60, 150},
                                                           {"Kidney", 110, 240},
                                                           {"Vessels with contrast", 130, 400},
                                                           {"Bone", 250, 3000}}};

}  // namespace trocar::modeller
