#include <algorithm>
#include <limits>

#include <trocar/core/require.hpp>
#include <trocar/volumes/segment/label_change.hpp>

namespace trocar::volumes {
namespace {

void relabel(Labels& labels, const LabelChange& change, bool backwards) {
  const auto was = [&](const LabelRun& r) { return backwards ? r.to : r.from; };
  for (const LabelRun& r : change.runs) {
    core::require(std::size_t(r.first) + r.count <= labels.at.size(), "the change is of larger labels");
    const auto first = labels.at.begin() + std::ptrdiff_t(r.first);
    core::require(std::all_of(first, first + std::ptrdiff_t(r.count), [&](std::uint16_t l) { return l == was(r); }),
                  "the change is of other labels");
  }
  for (const LabelRun& r : change.runs)
    std::fill_n(labels.at.begin() + std::ptrdiff_t(r.first), r.count, backwards ? r.from : r.to);
}

}  // namespace

std::size_t LabelChange::voxels() const {
  std::size_t out = 0;
  for (const LabelRun& r : runs) out += r.count;
  return out;
}

void apply(Labels& labels, const LabelChange& change) { relabel(labels, change, false); }
void undo(Labels& labels, const LabelChange& change) { relabel(labels, change, true); }

double gained_ml(const LabelChange& change, int label, const Grid& grid) {
  double voxels = 0;
  for (const LabelRun& r : change.runs) voxels += double(r.count) * ((r.to == label) - (r.from == label));
  return voxels * grid.voxel_ml();
}

ChangeWriter::ChangeWriter(const Labels& labels) : m_labels(labels) {
  core::require(labels.at.size() <= std::numeric_limits<std::uint32_t>::max(),
                "labels must have fewer than 2^32 voxels");
}

}  // namespace trocar::volumes
