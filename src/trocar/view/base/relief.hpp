// Unevenness of a drawn organ that its mechanics do not have: soft waves of its surface, follicles of an ovary. Heights
// along the normal, made once at rest, so that they ride on the tissue.
#pragma once

#include <vector>

#include <trocar/tissue/network/skin.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

struct Relief {
  double broad = 0, broad_size = 0.02;      ///< height and wavelength of the larger waves [m]
  double fine = 0, fine_size = 0.006;       ///< of the smaller ones
  int follicles = 0;                        ///< blisters at places that a fixed pattern chooses
  double follicle_radius = 0.003;           ///< the largest [m]
  int scars = 0;                            ///< short pale furrows where follicles have burst
  double ripe = 0;                          ///< radius of one ripe follicle, or on some of its corpus luteum [m]
  double lopsided = 0;                      ///< flat and full places of an organ as a whole, each organ's own [m]
  double haustra = 0, haustra_size = 0.03;  ///< height and distance of a large gut's bulges along its length [m];
                                            ///< three bands run along between them
  double spiral = 0, spiral_size = 0.0035;  ///< of a strand: height and pitch of a ridge that winds around it [m]

  /// Places where a strand grows out: the surface rises to meet it.
  struct Root {
    Vec3d at;
    double radius = 0;  ///< of the strand [m]
  };
  std::vector<Root> roots = {};

  bool any() const {
    return broad > 0 || fine > 0 || follicles > 0 || haustra > 0 || lopsided > 0 || ripe > 0 || !roots.empty();
  }
};

/// Height over each vertex [m]. Follicles and a gut's bands also paint themselves (Paint::tint).
std::vector<float> heights(const Relief& relief, const tissue::Skin& skin, std::vector<Paint>& paint);

/// Rest coordinates for patterns: of a gut finer along it than around it, as its vessels run round; else the skin's.
std::vector<Vec3f> pattern_coordinates(const Relief& relief, const tissue::Skin& skin);

/// A smooth number in about -1..1 that varies over `size` [m].
double waves(Vec3d p, double size);

}  // namespace trocar::view
