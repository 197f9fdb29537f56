#include <trocar/core/require.hpp>
#include <trocar/volumes/organ/label_voxels.hpp>

namespace trocar::volumes {

geometry::Voxels label_voxels(const Labels& labels, int label) {
  const Box box = box_of(labels, label);
  core::require(!box.empty(), "no voxel has this label");
  geometry::Voxels out;
  for (std::size_t a = 0; a < 3; ++a) out.size[a] = box.high[a] - box.low[a] + 2;
  const Vec3d first{double(box.low[0] - 1), double(box.low[1] - 1), double(box.low[2] - 1)};
  out.origin = scene_from_patient(labels.grid.to_patient(first));
  out.step = 1e-3 * (kSceneFromPatient * labels.grid.step());
  std::vector<std::uint8_t> values(out.count());
  for (int k = box.low[2]; k < box.high[2]; ++k)
    for (int j = box.low[1]; j < box.high[1]; ++j)
      for (int i = box.low[0]; i < box.high[0]; ++i)
        values[out.index(i - box.low[0] + 1, j - box.low[1] + 1, k - box.low[2] + 1)] =
            labels.at[labels.grid.index(i, j, k)] == label ? 1 : 0;
  out.values = std::move(values);
  return out;
}

}  // namespace trocar::volumes
