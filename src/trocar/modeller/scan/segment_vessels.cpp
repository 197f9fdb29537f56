#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/modeller/operations/operation.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/operations/vessel_text.hpp>
#include <trocar/modeller/scan/segment_vessels.hpp>
#include <trocar/scene/json/json_text.hpp>
#include <trocar/volumes/organ/centre_line.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;
using volumes::CentreTree;

constexpr double kApart = 0.003;                       // [m] between points of a vessel's path
constexpr double kLeastRadius = 2e-4, kWaveSpeed = 7;  // [m], [m/s]

std::vector<std::vector<int>> children_of(const CentreTree& tree) {
  std::vector<std::vector<int>> out(tree.points.size());
  for (std::size_t i = 0; i < tree.parent.size(); ++i)
    if (tree.parent[i] >= 0) out[std::size_t(tree.parent[i])].push_back(int(i));
  return out;
}

/// From a point on to where it branches or ends.
std::vector<int> stretch(const std::vector<std::vector<int>>& children, int from, int next) {
  std::vector<int> line{from, next};
  while (children[std::size_t(line.back())].size() == 1) line.push_back(children[std::size_t(line.back())].front());
  return line;
}

JsonValue vessel(const CentreTree& tree, const std::vector<int>& line, const std::string& name, const std::string& from,
                 const std::string& to, Vec3d move_mm) {
  std::vector<Vec3d> path;
  Vec3d last;
  for (const int i : line) {
    const Vec3d at = tree.points[std::size_t(i)].at;
    if (!path.empty() && i != line.back() && length(at - last) < kApart) continue;
    path.push_back(at * 1e3 + move_mm);
    last = at;
  }
  const auto radius = [&](std::size_t share) {
    const int i = line[(line.size() - 1) * share / 4];
    return number(1e3 * std::max(kLeastRadius, tree.points[std::size_t(i)].radius));
  };
  JsonValue out = scene::json_object();
  scene::put(out, "name", scene::json_text(name));
  scene::put(out, "from", scene::json_text(from));
  scene::put(out, "to", scene::json_text(to));
  scene::put(out, "path_mm", points(path));
  scene::put(out, "radius_mm", radius(1));
  scene::put(out, "radius_to_mm", radius(3));
  scene::put(out, "wave_speed_m_s", number(kWaveSpeed));
  return out;
}

/// Vessels from the root on, and the radius at each end.
struct Written {
  std::vector<JsonValue> vessels;
  std::vector<std::pair<std::string, double>> ends;
};

Written written_tree(const CentreTree& tree, const std::string& name, Vec3d move_mm) {
  const std::vector<std::vector<int>> children = children_of(tree);
  Written out;
  std::vector<std::pair<int, std::string>> open;
  for (std::size_t i = 0; i < tree.parent.size(); ++i)
    if (tree.parent[i] < 0) open.emplace_back(int(i), "root");
  for (std::size_t at = 0; at < open.size(); ++at)
    for (const int next : children[std::size_t(open[at].first)]) {
      const std::vector<int> line = stretch(children, open[at].first, next);
      const std::string its = fmt::format("{}_{}", name, out.vessels.size() + 1), to = its + "_end";
      out.vessels.push_back(vessel(tree, line, its, open[at].second, to, move_mm));
      if (children[std::size_t(line.back())].empty())
        out.ends.emplace_back(to, std::max(kLeastRadius, tree.points[std::size_t(line.back())].radius));
      else
        open.emplace_back(line.back(), to);
    }
  return out;
}

}  // namespace

std::size_t make_vessels(Document& document, const Scan& scan, const VesselWish& wish) {
  const fs::path file = whole_path(document.root().parent_path() / wish.file);
  const auto refuse = [](const fs::path& path, std::string message) {
    throw core::BadInput({{{path.generic_string(), 0, 0}, std::move(message)}});
  };
  Draft draft(document);
  if (draft.has(file)) refuse(file, "expected the name of a new file, got one that is there");
  volumes::TreeOptions options;
  options.least_branch_mm = wish.least_branch_mm;
  if (wish.root_mm) options.root_mm = volumes::patient_from_scene(*wish.root_mm * 1e-3);
  CentreTree tree;
  try {
    tree = volumes::centre_tree(scan.labels(), scan.segment_there(wish.segment), options);
  } catch (const std::invalid_argument& none) {
    refuse(scan.path(), none.what());
  }
  const Written made = written_tree(tree, wish.name, wish.move_mm.value_or(Vec3d{0, 0, 0}));
  if (made.vessels.empty())
    refuse(scan.path(), "expected a segment that is longer than thick, got one without a middle line");
  double cubes = 0;
  for (const auto& [node, radius] : made.ends) cubes += radius * radius * radius;
  VesselText text;
  text.name = wish.name;
  text.flow_mL_min = wish.flow_mL_min;
  text.vessels = made.vessels;
  for (const auto& [node, radius] : made.ends)
    text.ends.push_back(vessel_end(node, wish.flow_mL_min * radius * radius * radius / cubes));
  put_vessel_file(draft, wish.file, written_vessels(text));
  commit(document, "vessels from " + wish.segment, draft);
  return made.vessels.size();
}

}  // namespace trocar::modeller
