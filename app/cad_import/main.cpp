// trocar_cad: STEP and IGES for the modeller's step `from_file`. Leaves a mesh of every part in a folder [mm], and what
// it is as a NURBS where it is one; tells of them, and of the file's unit, as JSON.
//
//   build/release/trocar_cad part.step --into FOLDER [--within-mm 0.05]
//
// Exit: 0 done, 2 a file that cannot be read. Whatever the file holds, it takes two minutes and 4 GB at most.
#include <cstdio>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <Standard_Failure.hxx>
#include <sys/resource.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/json.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>

#include "cad_file.hpp"
#include "cad_parts.hpp"

namespace {

using trocar::Json;
namespace fs = std::filesystem;

constexpr unsigned kSeconds = 120;
constexpr rlim_t kBytes = rlim_t(4) << 30;

void bound() {
  const rlimit memory{kBytes, kBytes};
  setrlimit(RLIMIT_AS, &memory);
  alarm(kSeconds);
}

Json as_json(const trocar::scene::NurbsShape& shape) {
  Json net = Json::array(), weights = Json::array();
  for (int r = 0; r < shape.rows; ++r) {
    Json row = Json::array(), row_weights = Json::array();
    for (int c = 0; c < shape.columns; ++c) {
      const std::size_t i = std::size_t(r * shape.columns + c);
      row.push_back({shape.net[i].x * 1e3, shape.net[i].y * 1e3, shape.net[i].z * 1e3});
      if (!shape.weights.empty()) row_weights.push_back(shape.weights[i]);
    }
    net.push_back(row);
    if (!shape.weights.empty()) weights.push_back(row_weights);
  }
  Json out{{"degree", {shape.degree[0], shape.degree[1]}}, {"net_mm", net}};
  if (!weights.empty()) out["weights"] = weights;
  out["knots_u"] = shape.knots_u;
  out["knots_v"] = shape.knots_v;
  if (shape.closing == trocar::scene::NurbsShape::ring) out["closed"] = "ring";
  return out;
}

int import(const fs::path& file, const fs::path& into, double within_mm, double unit_mm) {
  Json parts = Json::array();
  int number = 0;
  const trocar::cad::CadFile read = trocar::cad::read_cad(file);
  const double within = 1e-3 * within_mm * (unit_mm > 0 ? read.unit_mm / unit_mm : 1);  // in the size that it says
  for (const TopoDS_Shape& part : read.parts) {
    const std::string name = "part_" + std::to_string(++number) + ".stl";
    const std::string bytes = trocar::geometry::to_stl(
        trocar::cad::triangles_of(part, unit_mm > 0 ? within : trocar::cad::within_of_size(part, within)), 1e-3);
    if (const std::string said = trocar::core::write_file(into / name, bytes.data(), bytes.size()); !said.empty()) {
      std::fprintf(stderr, "%s: %s\n", (into / name).c_str(), said.c_str());
      return 2;
    }
    Json one{{"mesh", name}, {"faces", trocar::cad::faces_of(part)}};
    if (const auto shape = trocar::cad::nurbs_of(part)) one["nurbs"] = as_json(*shape);
    parts.push_back(one);
  }
  std::printf("%s\n", Json{{"unit_mm", read.unit_mm}, {"parts", parts}}.dump().c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Parts of a STEP or IGES file, as meshes and NURBS");
  std::string file, into;
  double within = 0.05, unit = 0;
  program.add_option("file", file)->required();
  program.add_option("--into", into, "folder")->required();
  program.add_option("--within-mm", within, "how far a mesh may be from its part")->check(CLI::Range(0.001, 10.0));
  program.add_option("--unit-mm", unit, "the unit that its numbers really are in; default: what it says");
  CLI11_PARSE(program, argc, argv);
  bound();
  try {
    return import(file, into, within, unit);
  } catch (const trocar::core::BadInput& bad) {
    std::fprintf(stderr, "%s\n", trocar::core::to_string(bad.faults().front()).c_str());
  } catch (const Standard_Failure& failed) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), failed.GetMessageString());
  } catch (const std::exception& failed) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), failed.what());
  }
  return 2;
}
