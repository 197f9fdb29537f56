// The reader of NRRD volumes, and what is made of them: the field of a label, its body.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/core/error.hpp>
#include <trocar/geometry/tets/stuffing.hpp>
#include <trocar/geometry/voxel_files/nrrd.hpp>

#include "../geometry/nrrd_bytes.hpp"
#include "targets.hpp"

namespace trocar::fuzz {
namespace {

using namespace geometry;

constexpr std::size_t kMostVoxelsOfOne = 4096;

void check(const Voxels& voxels) {
  require(voxels.count() >= 1 && voxels.count() <= kMostVoxelsOfOne, "a volume has voxels, and not too many");
  require(std::visit([](const auto& values) { return values.size(); }, voxels.values) == voxels.count(),
          "every voxel has a value");
  for (int k = 0; k < voxels.size[2]; ++k)
    for (int j = 0; j < voxels.size[1]; ++j)
      for (int i = 0; i < voxels.size[0]; ++i) require(std::isfinite(voxels.at(i, j, k)), "values are finite");
  const Vec3d p = voxels.centre({double(voxels.size[0]), double(voxels.size[1]), double(voxels.size[2])});
  require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "places are finite");
}

/// Whatever the label of the first voxel encloses: a body, or the reason why not.
void check_body(const Voxels& voxels) {
  const double value = voxels.at(0, 0, 0);
  if (!(std::fabs(value) < 1e9)) return;
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, length(voxels.step.column(k)) * voxels.size[k]);
  StuffingOptions options;
  options.most_cells = 2000;
  try {
    const TetMesh body = stuffed(voxels, int(value), longest / 6, options);
    const TetFacts facts = inspect(body, 0);
    require(facts.cells > 0 && facts.cells <= options.most_cells, "a body has cells, and not too many");
    require(facts.inverted == 0 && facts.duplicate_cells == 0 && facts.unused_nodes == 0, "its cells are upright");
    require(check_edges(surface_of(body).mesh).closed(), "its surface is closed and touches itself in no edge");
  } catch (const std::invalid_argument&) {
  }
}

}  // namespace

void nrrd_file(Bytes bytes) {
  Voxels voxels;
  try {
    NrrdOptions options;
    options.most_voxels = kMostVoxelsOfOne;
    voxels = voxels_of(read_nrrd(text_of(bytes), "memory.nrrd", options), "memory.nrrd");
  } catch (const core::BadInput& bad) {
    require(!bad.faults().empty() && bad.faults().size() <= 51, "faults are bounded");
    for (const core::Fault& f : bad.faults()) require(!f.message.empty(), "a fault says what was expected");
    return;
  }
  check(voxels);
  check_body(voxels);
}

std::vector<Seed> nrrd_seeds() {
  const std::string numbers = nrrd_numbers<std::int16_t>(false);
  std::string ras = nrrd_header("float", "raw", "big") + nrrd_numbers<float>(true);
  ras.replace(ras.find("left-posterior-superior"), 23, "RAS");
  std::string block = nrrd_header("uchar", "gzip"), values(512, '\5');  // enough of a label for a body, with a hole
  block.replace(block.find("2 3 2"), 5, "8 8 8");
  for (int i = 0; i < 8; ++i) values[std::size_t(292 + (i & 1) + 8 * (i >> 1 & 1) + 64 * (i >> 2))] = '\1';
  return {{"block", bytes_of(block + gzipped(values))},
          {"block-raw", bytes_of(block.replace(block.find("gzip"), 4, "raw") + values)},
          {"ascii", bytes_of(nrrd_header("int16", "ascii") + kNrrdText)},
          {"raw", bytes_of(nrrd_header("short", "raw") + numbers)},
          {"bytes", bytes_of(nrrd_header("uchar", "raw") + nrrd_numbers<std::uint8_t>(false))},
          {"gzip", bytes_of(nrrd_header("short", "gzip") + gzipped(numbers))},
          {"big-ras", bytes_of(ras)},
          {"double", bytes_of(nrrd_header("double", "gzip") + gzipped(nrrd_numbers<double>(false)))}};
}

std::vector<std::string> nrrd_words() {
  return {"NRRD0004\n",
          "NRRD0005\n",
          "type: uchar\n",
          "type: int\n",
          "type: double\n",
          "dimension: 3\n",
          "sizes: 2 3 2\n",
          "sizes: 16 16 16\n",
          "space: LPS\n",
          "space: RAS\n",
          "space directions: (1,0,0) (0,1,0) (0,0,1)\n",
          "space origin: (0,0,0)\n",
          "space units: \"mm\" \"mm\" \"mm\"\n",
          "space units: \"m\" \"m\" \"m\"\n",
          "spacings: 1 1 1\n",
          "endian: big\n",
          "endian: little\n",
          "encoding: raw\n",
          "encoding: gzip\n",
          "encoding: ascii\n",
          "byte skip: 0\n",
          "none",
          "nan",
          "1e6",
          "1e-6",
          "134217728",
          "9223372036854775807",
          "-1",
          "\n\n",
          "\r\n"};
}

}  // namespace trocar::fuzz
