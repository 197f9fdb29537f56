// Mending of tetrahedral meshes, one kind of fault after the other.
#include <algorithm>
#include <utility>

#include <trocar/geometry/tets/tet_faces.hpp>
#include <trocar/geometry/tets/tet_mesh.hpp>
#include <trocar/geometry/tets/tet_overlap.hpp>

namespace trocar::geometry {
namespace {

/// Leaves out the cells that are marked; how many.
int drop_cells(TetMesh& mesh, const std::vector<bool>& drop) {
  std::size_t kept = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (drop[c]) continue;
    mesh.cells[kept] = mesh.cells[c];
    if (!mesh.region.empty()) mesh.region[kept] = mesh.region[c];
    ++kept;
  }
  const int dropped = int(mesh.cells.size() - kept);
  mesh.cells.resize(kept);
  if (!mesh.region.empty()) mesh.region.resize(kept);
  return dropped;
}

/// Cells name the first of each place's nodes; the others stay behind, marked in `merged`.
int merge_nodes(TetMesh& mesh, const std::vector<int>& same, std::vector<bool>& merged) {
  int count = 0;
  for (int i = 0; i < int(same.size()); ++i) {
    merged[i] = same[i] != i;
    count += merged[i];
  }
  for (auto& cell : mesh.cells)
    for (int& node : cell) node = same[node];
  return count;
}

int drop_flat(TetMesh& mesh, double box_diagonal) {
  std::vector<bool> drop(mesh.cells.size());
  for (int c = 0; c < int(mesh.cells.size()); ++c) drop[c] = is_flat(mesh, c, box_diagonal);
  return drop_cells(mesh, drop);
}

int drop_duplicates(TetMesh& mesh) {
  std::vector<std::pair<std::array<int, 4>, int>> sorted;
  sorted.reserve(mesh.cells.size());
  for (int c = 0; c < int(mesh.cells.size()); ++c) {
    sorted.push_back({mesh.cells[c], c});
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> drop(mesh.cells.size());
  for (std::size_t i = 1; i < sorted.size(); ++i) drop[sorted[i].second] = sorted[i].first == sorted[i - 1].first;
  return drop_cells(mesh, drop);
}

int turn_inverted(TetMesh& mesh) {
  int turned = 0;
  for (int c = 0; c < int(mesh.cells.size()); ++c) {
    if (volume(mesh, c) >= 0) continue;
    std::swap(mesh.cells[c][2], mesh.cells[c][3]);
    ++turned;
  }
  return turned;
}

/// In the order of cells: one that lies on the same side of a face as one that stays overlaps that one.
int drop_overlapping(TetMesh& mesh) {
  std::vector<std::array<int, 4>> side(mesh.cells.size());  // of each cell's faces: the number of face and side
  int count = 0;
  const std::vector<TetFace> faces = sorted_faces(mesh);
  for_each_face(faces, [&](std::span<const TetFace> same) {
    for (const TetFace& face : same) side[face.cell][face.opposite] = 2 * count + face.outwards;
    ++count;
  });
  std::vector<bool> taken(2 * std::size_t(count)), drop(mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    drop[c] = std::any_of(side[c].begin(), side[c].end(), [&](int s) { return taken[s]; });
    if (drop[c]) continue;
    for (const int s : side[c]) taken[s] = true;
  }
  return drop_cells(mesh, drop);
}

/// Leaves out nodes without a cell; how many of them were not merged into another one.
int drop_nodes(TetMesh& mesh, const std::vector<bool>& merged) {
  const std::vector<bool> used = used_nodes(mesh);
  std::vector<int> number(mesh.points.size(), -1);
  std::size_t kept = 0;
  int dropped = 0;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    if (!used[i]) {
      dropped += !merged[i];
      continue;
    }
    number[i] = int(kept);
    mesh.points[kept++] = mesh.points[i];
  }
  mesh.points.resize(kept);
  for (auto& cell : mesh.cells)
    for (int& node : cell) node = number[node];
  return dropped;
}

}  // namespace

TetRepair repair(const TetMesh& broken, double tolerance) {
  TetRepair out{broken, {}};
  TetMesh& mesh = out.mesh;
  const auto note = [&](Mending what, int count) {
    if (count > 0) out.mended.push_back({what, count});
  };
  const std::vector<bool> used = used_nodes(mesh);
  const double size = diagonal(bounds_of(mesh.points, used));
  std::vector<bool> merged(mesh.points.size());
  note(Mending::merged_nodes, merge_nodes(mesh, same_nodes(mesh.points, used, tolerance * size), merged));
  note(Mending::dropped_flat, drop_flat(mesh, size));
  note(Mending::dropped_duplicates, drop_duplicates(mesh));
  note(Mending::turned, turn_inverted(mesh));
  note(Mending::dropped_overlapping, drop_overlapping(mesh));
  note(Mending::dropped_nodes, drop_nodes(mesh, merged));
  return out;
}

std::vector<std::string> left_as_is(const TetMesh& mended) {
  const TetFacts facts = inspect(mended);
  std::vector<std::string> out;
  if (facts.parts > 1) out.push_back(std::to_string(facts.parts) + " parts that share no face");
  if (facts.odd_edges > 0)
    out.push_back(std::to_string(facts.odd_edges) + " edge" + (facts.odd_edges == 1 ? "" : "s") +
                  " of the surface at which not exactly two of its triangles meet: cells that touch in an edge only, "
                  "or cracks");
  if (const CellOverlaps overlaps = cell_overlaps(mended); overlaps.pairs > 0) out.push_back(in_words(overlaps));
  return out;
}

std::string in_words(const Mended& mended) {
  const bool one = mended.count == 1;
  const auto words = [&]() -> const char* {
    switch (mended.what) {
      case Mending::merged_nodes:
        return one ? "duplicate node merged" : "duplicate nodes merged";
      case Mending::dropped_flat:
        return one ? "flat cell left out" : "flat cells left out";
      case Mending::dropped_duplicates:
        return one ? "duplicate cell left out" : "duplicate cells left out";
      case Mending::turned:
        return one ? "inverted cell turned" : "inverted cells turned";
      case Mending::dropped_overlapping:
        return one ? "cell that overlaps its neighbour left out" : "cells that overlap a neighbour left out";
      case Mending::dropped_nodes:
        break;
    }
    return one ? "node without a cell left out" : "nodes without a cell left out";
  };
  return std::to_string(mended.count) + ' ' + words();
}

}  // namespace trocar::geometry
