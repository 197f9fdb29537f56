// The four pictures that shading draws from, made at start from a fixed seed (no files): noise and cells, which tile
// in space and are sampled in rest coordinates, a plane of branching vessels, and the vessels of a fold.
#pragma once

#include <cstdint>
#include <vector>

namespace trocar::render {

/// Bytes of a texture, x fastest.
struct Pattern {
  int size = 0;      ///< texels along each edge (along x of a picture with its own `rows`)
  int channels = 0;  ///< bytes a texel
  std::vector<std::uint8_t> texels;
  int rows = 0;  ///< of a picture that is not square; 0 = size
};

inline constexpr int kNoiseFeatures = 8;     ///< wavelengths per tile of noise_pattern
inline constexpr int kCellFeatures = 8;      ///< cells per tile edge of cell_pattern
inline constexpr int kVesselTileWidth = 85;  ///< tile edge / width of the largest vessel

/// 64^3, RGBA: gradient (x y z, 128 = none) of three octaves and value of two octaves of value noise that
/// tile.
Pattern noise_pattern();
/// 64^3, RGBA: vector from the nearest cell centre (128 = none, 255 = one cell edge) and how near the next centre's
/// territory is (0 on the seam between two cells).   [Worley 96]
Pattern cell_pattern();
/// 1024^2, RG: arteries and capillaries, veins; coverage 0..255, tiles. Trees grow as random walks with Murray's law
/// at forks (r0^3 = r1^3 + r2^3).   [Murray 26]
Pattern vessel_pattern();
/// 1024 x 512, RG as above: the vessels between a tube and its ovary. x runs along the tube and tiles; y runs from the
/// tube (0) to the root. An arcade follows the tube at a quarter of the way, fed from the root and from both ends; fine
/// straight twigs leave it at right angles for the tube.   [Borell & Fernstroem 53: the tubal branches]
Pattern arcade_pattern();

/// 1024^2, RG as above, tiles: what an abdominal wall carries. Trunks cross the whole tile along y, an artery with a
/// vein beside it; branches leave them on alternate sides, 0.6 as wide, twigs 0.35, and thin out into nothing.
inline constexpr int kLiningTileWidth = 170;  ///< tile edge / width of a trunk
Pattern lining_pattern();

}  // namespace trocar::render
