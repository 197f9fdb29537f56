// A scan as numbers: 16 bits a voxel, and what they mean. CT is in Hounsfield units, slope and intercept are in it.
//
//   const double hu = volume.value(i, j, k);
//   const double between = volume.at(volume.grid.to_index(lps_mm));      // trilinear
//   const Statistics liver = statistics(volume, labels, 5);              // .mean
//
// One representation serves all: whole numbers that 65536 steps hold are kept exactly (CT, MR, labels as grey), others
// in equal steps from the least to the greatest value, `error` apart from what the file said.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <trocar/volumes/image/grid.hpp>
#include <trocar/volumes/image/progress.hpp>

namespace trocar::volumes {

struct Volume {
  Grid grid;
  std::vector<std::int16_t> stored;  ///< the first axis fastest, the third slowest
  double scale = 1, offset = 0;      ///< value = offset + scale * stored; scale > 0
  double error = 0;                  ///< greatest difference to the file's values; 0 where all are kept
  std::string unit;                  ///< of CT: "HU", or what the file says instead; empty where it is not known

  double value_of(std::int16_t number) const { return offset + scale * number; }
  double value(int i, int j, int k) const { return value_of(stored[grid.index(i, j, k)]); }
  double value(const Index3& v) const { return value(v[0], v[1], v[2]); }
  /// The nearest number that stands for a value, or the last one on that side.
  std::int16_t number_of(double value) const;
  /// Trilinear between the voxels' centres; beyond them as at the border.
  double at(Vec3d ijk) const;
};

struct Statistics {
  std::size_t count = 0;
  double least = 0, greatest = 0, mean = 0, deviation = 0;  ///< of the population
};
struct Labels;
Statistics statistics(const Volume& volume);
/// Of the voxels that carry a label; the grids must be of one size, else std::invalid_argument.
Statistics statistics(const Volume& volume, const Labels& labels, int label);
/// The value below which this share of the voxels is, exact to a step of the numbers.
double quantile(const Volume& volume, double share);

/// The volume on another grid, by place in the patient, trilinear. Outside it is `outside`, or the least value where
/// that is no number.
Volume resampled(const Volume& volume, const Grid& onto, double outside, const Progress& progress = {});

}  // namespace trocar::volumes
