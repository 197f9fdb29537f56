// Tissues and materials as a list to choose from: how firm a tissue is, how a material looks, which belong together,
// and which a body's name suggests.
#pragma once

#include <string>
#include <vector>

#include <trocar/modeller/document/document.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::modeller {

struct TissueChoice {
  std::string name;
  double young = 0;  ///< [Pa]
};
/// Those that the document knows, softest first.
std::vector<TissueChoice> tissue_choices(const Document& document);

struct MaterialChoice {
  std::string name;
  Vec3d colour, patches, flecks, vessels;  ///< sRGB, 0 to 255
};
/// Those of living tissue in the installed folder `scenes`, by name. Read once.
const std::vector<MaterialChoice>& material_choices();

/// The material that is called as the tissue is, a wall's as the organ that it encloses; empty: there is none.
std::string material_of_tissue(std::string tissue);
/// The tissue that a body's name suggests ("VH_F_Liver" -> "liver"); empty: none.
std::string tissue_for_name(const std::string& name, const std::vector<TissueChoice>& tissues);
/// The material that a body's name suggests, else the tissue's; empty: none.
std::string material_for(const std::string& name, const std::string& tissue);

}  // namespace trocar::modeller
