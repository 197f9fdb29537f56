// Materials: the appearance of surfaces and the anatomy drawn around them, from files under scenes/looks/: numbers
// without images, for drawing. The step reads nothing of it, and it is not in the Model's hash.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::sim {

/// Anatomy that is drawn only: who makes it, and how much of it.
struct Surrounding {
  enum class Generator {
    fat_tags,     ///< epiploic appendages of large bowel (view/anatomy/fat_tags.hpp)
    adhesions,    ///< strings and veils to the wall (adhesions.hpp)
    curtains,     ///< broad veils to the wall, as many as room is (adhesions.hpp)
    drape,        ///< peritoneum covers the body and runs out on what is around (drape.hpp)
    omentum,      ///< fat lies on the lowest part of such a wall (omentum.hpp)
    liver_dome,   ///< only the lower edge is simulated: the rest of the organ (liver_dome.hpp)
    bowel_loops,  ///< more bowel beside it, where a wall ends in a floor (bowel_loops.hpp)
    porta,        ///< fat over the ends of strands that go from such a wall into an organ (porta.hpp)
  };
  Generator generator{};
  int count = 1;  ///< of those that are counted, at most
};

/// Colours are sRGB, 0 to 255, as read off a picture; lengths [m]. What stands without comment is a share, 0 to 1.
struct Look {
  std::string name;

  enum class Surface { tissue, metal } surface = Surface::tissue;
  Vec3d colour{196, 134, 130};   ///< main
  Vec3d patches{204, 150, 142};  ///< broad ones
  Vec3d flecks{182, 112, 112};   ///< fine ones
  Vec3d tint{204, 150, 142};     ///< where something grows out or shimmers through
  double mottle_size = 0.012;    ///< of the patches
  double mottle = 0.5;
  double lobule_size = 0;  ///< 0: none
  double lobule_depth = 0, lobule_contrast = 0;
  double fibre_stretch = 1;
  double bump = 0.15;

  std::optional<Vec3d> vessel_colour;  ///< none: dark red
  double vessels = 0;
  double vessel_tile = 0.04;
  bool arcade = false, lining = false;

  double roughness = 0.45, wetness = 0.8;
  double film_roughness = 0.065, film_size = 0.003, film_bump = 0.30;
  double fresnel = 0.026;

  Vec3d wrap{0.45, 0.18, 0.16}, glow{0.9, 0.25, 0.18};  ///< linear
  double glow_amount = 0.06;
  double alpha = 1, rim_alpha = 1;
  bool translucent = false, two_sided = false;
  bool moulded = false;  ///< of a model: it goes into what holds it and does not grow out of it

  double scatter = 0, soil = 1;  ///< of metal

  /// Unevenness that mechanics do not have: heights and sizes (view/base/relief.hpp).
  struct Relief {
    double broad = 0, broad_size = 0.02, fine = 0, fine_size = 0.006;
    int follicles = 0, scars = 0;
    double follicle_radius = 0.003, ripe = 0, lopsided = 0;
    double haustra = 0, haustra_size = 0.03;
    double spiral = 0, spiral_size = 0.0035;
  } relief;
  std::vector<Surrounding> surroundings;
};

struct MaterialLibrary {
  std::vector<Look> looks;
};

}  // namespace trocar::sim
