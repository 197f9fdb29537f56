// Which organ a voxel belongs to: a number a voxel, 0 for none, and a name and colour for each number.
//
//   Labels labels = on_grid_of(volume);
//   labels.segments.push_back({1, "liver", {0.86f, 0.41f, 0.33f}});
//   const double ml = millilitres(labels, 1);
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <trocar/volumes/image/grid.hpp>
#include <trocar/volumes/image/progress.hpp>

namespace trocar::volumes {

struct Segment {
  std::uint16_t label = 0;
  std::string name;
  std::array<float, 3> colour{};  ///< red, green, blue, 0 .. 1
  bool visible = true;
};

struct Labels {
  Grid grid;
  std::vector<std::uint16_t> at;  ///< the first axis fastest, the third slowest
  std::vector<Segment> segments;  ///< ascending labels

  const Segment* find(int label) const;
};

struct Volume;
/// Nothing labelled yet, on the same grid.
Labels on_grid_of(const Volume& volume);
/// How many voxels carry each label: 65536 counts.
std::vector<std::size_t> voxels_per_label(const Labels& labels);
double millilitres(const Labels& labels, int label);
/// The voxels around a label; empty where there are none.
Box box_of(const Labels& labels, int label);
/// Every label that voxels carry has a segment, named "label 7" and coloured by number where it has none yet.
void name_all(Labels& labels);
/// A colour for a number, far from that of its neighbours.
std::array<float, 3> colour_of(int label);
/// The labels on another grid, by place in the patient, of the nearest voxel; 0 outside.
Labels resampled(const Labels& labels, const Grid& onto, const Progress& progress = {});

}  // namespace trocar::volumes
