// What a pass of a frame cost, where somebody asks (Backend::profile).
#pragma once

namespace trocar::render {

struct PassCost {
  const char* pass = "";    ///< its name; lives as long as the program
  double wall_ms = 0;       ///< until the driver said that it was done
  double processor_ms = 0;  ///< of all threads of this program: a software driver draws on several
  double gpu_ms = 0;        ///< by the graphics card's own clock; 0 where the driver has none
};

}  // namespace trocar::render
