// Arteries or veins as tubes along their lines: they move with what carries them, widen with the pulse (times the gain
// that their file declares), narrow under clips, and end in stumps where they are cut.
#pragma once

#include <vector>

#include <trocar/sim/model/vessel_cuts.hpp>
#include <trocar/view/base/level_of_detail.hpp>

namespace trocar::view {

/// Does a fold carry any of it?
bool in_a_fold(const interactions::VesselPath& path);
/// Does any of it not run below the peritoneum?
bool is_in_sight(const interactions::VesselPath& path);

class VesselDrawing {
 public:
  enum class Lie {
    anywhere,
    in_a_fold,
    elsewhere,
    below_too,  ///< anywhere, and what runs below the peritoneum
  };
  /// @param veins  veins, or arteries; of these all that lie there
  VesselDrawing(const sim::Model& model, bool veins, render::Backend& backend, const Detail& detail = {},
                Lie lie = Lie::anywhere);

  void update(const sim::State& state);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }
  /// Of the blood within, at the buffer's vertices [Pa].
  const std::vector<float>& pressures() const { return m_pressure; }

 private:
  /// What hangs together of a vessel.
  struct Run {
    int vessel = 0;
    double from = 0, to = 1;
    bool cut_from = false, cut_to = false;
    bool fades_from = false, fades_to = false;  ///< ends in tissue: thins out
    std::uint32_t first = 0;                    ///< vertex
    std::vector<double> s;                      ///< of its rings
    std::vector<Vec3d> line;                    ///< their places now
  };
  bool leads_on(int vessel, int end) const;
  void lay_out(const sim::State& state);
  void join(const Run& run, std::size_t rings_apart, std::uint32_t stride, MeshBuffer& into) const;
  void place(const sim::State& state);
  void round_meetings();
  std::vector<Vec3d> line_of(const Run& run, const sim::State& state, std::span<const Vec3d> points) const;
  void place_run(const Run& run, const sim::State& state);

  const sim::Model* m_model;
  bool m_veins;
  Lie m_lie;
  std::vector<interactions::VesselPath> m_paths;  ///< (vessels) the model's, nearer to what carries them
  std::vector<Run> m_runs;
  std::vector<double> m_errors;  ///< (levels) [m]
  int m_laid_out_for = -1;       ///< openings
  MeshBuffer m_buffer;
  std::vector<float> m_pressure;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
