// Tissues and materials as lists with pictures.
#pragma once

#include <string>
#include <vector>

#include <trocar/modeller/materials/materials.hpp>

namespace trocar::app {

/// A list that opens over what is below. True: `chosen` is another one now.
bool draw_tissue_list(const std::string& id, const std::vector<modeller::TissueChoice>& tissues, std::string& chosen);
bool draw_material_list(const std::string& id, std::string& chosen);

}  // namespace trocar::app
