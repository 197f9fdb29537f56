#include <cstdlib>

#include <fmt/format.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/run_program.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/modeller/operations/cad_file.hpp>
#include <trocar/modeller/operations/values.hpp>

namespace trocar::modeller {
namespace {

constexpr std::size_t kMostSaid = std::size_t(64) << 20;  // control nets are part of what it says

/// Beside the program itself; $TROCAR_CAD names another place.
fs::path cad_program() {
  if (const char* given = std::getenv("TROCAR_CAD")) return given;
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path() / "trocar_cad";
}

/// A folder that goes when it does.
class PassingFolder {
 public:
  PassingFolder() {
    std::string name = (fs::temp_directory_path() / "trocar-cad-XXXXXX").string();
    if (mkdtemp(name.data())) m_path = name;
  }
  ~PassingFolder() {
    std::error_code ignored;
    if (!m_path.empty()) fs::remove_all(m_path, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  const fs::path& path() const { return m_path; }

 private:
  fs::path m_path;
};

}  // namespace

bool is_tet_file(const fs::path& file) {
  const std::string ending = core::in_small_letters(file.extension().string());
  if (ending != ".vtk" && ending != ".msh") return false;
  std::error_code error;
  return fs::is_regular_file(file, error) && geometry::holds_tetrahedra(core::read_file(file, geometry::kMaxMeshBytes));
}

bool is_cad_file(const fs::path& file) {
  const std::string ending = core::in_small_letters(file.extension().string());
  return ending == ".step" || ending == ".stp" || ending == ".iges" || ending == ".igs";
}

std::vector<CadPart> read_cad_file(const fs::path& file, double within, std::optional<double> unit) {
  const fs::path program = cad_program();
  std::error_code error;
  if (!fs::exists(program, error))
    throw core::EnvironmentLacks(
        "STEP and IGES files need Open CASCADE, which is not installed: ./run.sh modeller installs and builds what is "
        "missing (188 MB)");
  const auto refuse = [&](const std::string& message) {
    throw core::BadInput({{{file.generic_string(), 0, 0}, message}});
  };
  if (!fs::is_regular_file(file, error)) refuse("expected a file, got none of this name");
  const PassingFolder folder;
  std::vector<std::string> words{fs::absolute(file).string(), "--into", folder.path().string(), "--within-mm",
                                 fmt::format("{}", within * 1e3)};
  if (unit) words.insert(words.end(), {"--unit-mm", fmt::format("{}", *unit * 1e3)});
  const core::ProgramEnd end = core::run_program(program, words, kMostSaid);
  if (!end.started) throw core::EnvironmentLacks(tr("{} could not be started", program.string()));
  if (end.status != 0)
    refuse(tr("expected a STEP or IGES file that can be read, got: {}",
              end.status == 2 && !end.output.empty() ? end.output.substr(0, end.output.find('\n'))
                                                     : "its reader did not come to an end"));
  std::vector<core::Fault> faults;
  const scene::JsonDocument said = scene::parse_json(end.output, "", faults);
  const scene::JsonMember* parts = said.root.find("parts");
  if (!faults.empty() || !parts) refuse("expected its parts, got nothing that can be understood");
  std::vector<CadPart> out;
  for (const scene::JsonValue& part : parts->value.items) {
    CadPart one;
    one.faces = int(number_in(part, "faces", 0));
    one.unit = number_in(said.root, "unit_mm", 1) * 1e-3;
    const scene::JsonMember *mesh = part.find("mesh"), *nurbs = part.find("nurbs");
    if (!mesh) refuse("expected a mesh of every part, got none");
    one.mesh = geometry::joined(geometry::read_surface_file(folder.path() / mesh->value.text));
    for (Vec3d& p : one.mesh.positions) p = p * 1e-3;
    if (nurbs) one.nurbs = nurbs->value;
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace trocar::modeller
