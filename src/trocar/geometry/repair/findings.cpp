// A diagnosis in words.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/repair/examine.hpp>

namespace trocar::geometry {
namespace {

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string millimetres(double metres) { return fmt::format("{:.3g} mm", 1000 * metres); }

std::string holes_in_words(const Diagnosis& d) {
  double longest = 0;
  for (const Rim& rim : d.holes) longest = std::max(longest, rim.length);
  return tr("{}, {}, the longest {} around", counted(d.holes.size(), "hole", "holes"),
            counted(std::size_t(d.open_edges()), "open edge", "open edges"), millimetres(longest));
}

std::string shells_in_words(const Diagnosis& d) {
  double largest = 0, all = 0;
  int cavities = 0;
  for (const Shell& shell : d.shells.list) {
    largest = std::max(largest, shell.area);
    all += shell.area;
    cavities += shell.is_cavity;
  }
  std::string words = tr("{} separate shells, the largest with {:.3g} % of the area", d.shells.list.size(),
                         all > 0 ? 100 * largest / all : 0.0);
  if (cavities > 0) words += fmt::format(", {}", counted(std::size_t(cavities), "cavity", "cavities"));
  return words;
}

}  // namespace

std::vector<Finding> findings(const Diagnosis& d) {
  std::vector<Finding> out;
  const auto add = [&](MeshFault fault, std::size_t count, std::string words, const char* remedy) {
    if (count > 0) out.push_back({fault, int(count), std::move(words), remedy});
  };
  const auto tell = [&](MeshFault fault, std::size_t count, const char* one, const char* many, const char* remedy) {
    add(fault, count, counted(count, one, many), remedy);
  };
  tell(MeshFault::not_finite, d.not_finite.size(), "vertex with a coordinate that is not a number",
       "vertices with coordinates that are not numbers", "without_broken");
  tell(MeshFault::duplicate_vertices, d.duplicate_vertices.size(), "vertex at the place of another one",
       "vertices at the places of others", "welded");
  tell(MeshFault::degenerate, d.degenerate.size(), "triangle without area", "triangles without area",
       "without_degenerate");
  tell(MeshFault::duplicate_triangles, d.duplicate_triangles.size(), "duplicate triangle", "duplicate triangles",
       "without_duplicates");
  tell(MeshFault::unused, d.unused.size(), "vertex without triangles", "vertices without triangles", "without_unused");
  tell(MeshFault::crowded_edges, d.crowded_edges.size(), "edge with more than two triangles",
       "edges with more than two triangles", "parted");
  tell(MeshFault::pinched_vertices, d.pinched_vertices.size(), "vertex in which surfaces only touch",
       "vertices in which surfaces only touch", "parted");
  tell(MeshFault::turned_edges, d.turned_edges.size(), "edge whose triangles face different ways",
       "edges whose triangles face different ways", "oriented");
  tell(MeshFault::inward, d.inward.size(), "shell that faces inwards", "shells that face inwards", "oriented");
  add(MeshFault::holes, d.holes.size(), holes_in_words(d), "with_holes_closed");
  add(MeshFault::crossings, d.crossings.size(),
      tr("{}{} that cross", d.all_crossings ? "" : "more than ",
         counted(d.crossings.size(), "pair of triangles", "pairs of triangles")),
      "resolved");
  add(MeshFault::several_shells, d.shells.list.size() > 1 ? d.shells.list.size() : 0, shells_in_words(d),
      "without_small_shells");
  add(MeshFault::slivers, d.slivers.size(),
      tr("{}, the least angle {:.2g} degrees", counted(d.slivers.size(), "thin triangle", "thin triangles"),
         d.least_angle),
      "remeshed");
  return out;
}

std::string in_words(const Diagnosis& d) {
  std::string out = fmt::format("{}, {}", counted(std::size_t(d.vertices), "vertex", "vertices"),
                                counted(std::size_t(d.triangles), "triangle", "triangles"));
  if (!d.shells.list.empty()) {
    const Vec3d side = 1000.0 * (d.box.high - d.box.low);
    out += fmt::format(", {:.3g} x {:.3g} x {:.3g} mm, {:.4g} cm2, {:.4g} ml", side.x, side.y, side.z, 1e4 * d.area,
                       1e6 * d.volume);
  }
  out += d.is_body() ? ": a body\n" : "\n";
  for (const Finding& f : findings(d)) out += f.words + " (" + f.remedy + ")\n";
  return out;
}

}  // namespace trocar::geometry
