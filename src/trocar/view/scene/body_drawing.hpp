// The inside of a person: every organ, tube, fold, vessel and wall of a scene, with what is drawn only (margins, loops
// of bowel, drapes, ridges, adhesions, fat, omentum). Made once from the Model, moved to a State, listed for a frame.
#pragma once

#include <optional>
#include <vector>

#include <trocar/render/meshes/openness.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/view/analysis/scene_parts.hpp>
#include <trocar/view/anatomy/adhesions.hpp>
#include <trocar/view/anatomy/bowel_loops.hpp>
#include <trocar/view/anatomy/drape.hpp>
#include <trocar/view/anatomy/fat_tags.hpp>
#include <trocar/view/anatomy/joint.hpp>
#include <trocar/view/anatomy/liver_dome.hpp>
#include <trocar/view/anatomy/porta.hpp>
#include <trocar/view/anatomy/raw_bed.hpp>
#include <trocar/view/anatomy/ridge.hpp>
#include <trocar/view/base/heat_marks.hpp>
#include <trocar/view/base/listing.hpp>
#include <trocar/view/bodies/breach_drawing.hpp>
#include <trocar/view/bodies/cuttable_drawing.hpp>
#include <trocar/view/bodies/mark_drawing.hpp>
#include <trocar/view/bodies/membrane_drawing.hpp>
#include <trocar/view/bodies/organ_drawing.hpp>
#include <trocar/view/bodies/pouch_drawing.hpp>
#include <trocar/view/bodies/sheet_drawing.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>
#include <trocar/view/bodies/vessel_drawing.hpp>
#include <trocar/view/bodies/wall_surface.hpp>
#include <trocar/view/bonds/bond_drawing.hpp>
#include <trocar/view/bonds/bond_veils.hpp>
#include <trocar/view/fluids/drip_stains.hpp>

namespace trocar::view {

class BodyDrawing {
 public:
  BodyDrawing(const sim::Model& model, render::Backend& backend);

  void update(const sim::State& state);

  /// What encloses the scene beyond the model's walls: seen from inside only.
  void list_surroundings(const FirstParts& first, const Listing& to);
  void list(bool with_walls, const FirstParts& first, const Listing& to);
  void list_walls(const FirstParts& first, const Listing& to);

  /// Blood that runs down from cut organs.
  void list_ooze(render::Liquid& liquid) const;

  /// Names of the kinds of vessels that there are, as parts.
  std::vector<std::string> vessel_kinds() const;
  /// What continues from the model's walls: trocars come through it, too.
  const MeshBuffer& cavity() const { return m_cavity_shape; }
  /// Colour of the light that the walls return: tissue's pink, or a box's own.
  Vec3f returned() const;
  /// Of the model's walls: seen from outside only their inner side is drawn.
  bool is_wall(render::MeshHandle mesh) const;

 private:
  /// Arteries or veins, in folds or elsewhere.
  struct DrawnVessels {
    VesselDrawing drawing;
    bool in_a_fold = false;
    std::size_t look = 0;  ///< its number among the scene's
  };
  /// Where a strand's end grows out of an organ.
  struct TubeJoint {
    std::size_t tube = 0;
    int organ = -1;  ///< -1: a wall
    Joint joint;
  };

  LiverShape liver_shape(int organ) const;
  void make_tubes(const WallSurface& walls);
  void make_cuttables(render::Backend& backend);
  render::OpennessBaker shading() const;
  void make_organs(const render::OpennessBaker& baker, render::Backend& backend);
  void make_on_organs(const WallSurface& walls, render::Backend& backend);
  void make_portas(render::Backend& backend);
  void make_aprons(const WallSurface& walls);
  void make_wall(const sim::WallModel& wall, const render::OpennessBaker& baker, render::Backend& backend);
  void shade_aprons();
  void make_surroundings(const WallSurface& walls, const render::OpennessBaker& baker, render::Backend& backend);
  void make_joints(const WallSurface& walls, render::Backend& backend);
  void make_vessels(render::Backend& backend);
  void make_membranes(render::Backend& backend);
  bool held(BodyId body) const;
  void list_organs(bool with_walls, const FirstParts& first, const Listing& to);
  void list_tubes(bool with_walls, const FirstParts& first, const Listing& to);
  void list_folds(bool with_walls, const FirstParts& first, const Listing& to);
  void list_vessels(bool in_folds, const FirstParts& first, const Listing& to);

  render::DrawItem as_lining(render::DrawItem item) const;

  const sim::Model* m_model;
  const Look* m_wall_look;             ///< of all that continues from the walls
  render::Material m_lining;           ///< the same with its vessels' place in this scene
  std::vector<OrganDrawing> m_organs;  ///< solids
  std::vector<CuttableDrawing> m_cuttables;
  std::vector<HeatMarks> m_burns, m_cuttable_burns;  ///< (organs)
  std::vector<Blanching> m_blanching;                ///< (lattices)
  std::vector<FatTags> m_fat;
  std::vector<int> m_fat_on;  ///< its organ
  std::vector<Drape> m_drapes;
  std::vector<const Look*> m_drape_look;
  std::vector<TubeDrawing> m_tubes;
  std::vector<TubeJoint> m_joints;
  std::optional<Adhesions> m_adhesions;
  std::vector<Ridge> m_ridges;
  std::vector<std::size_t> m_ridge_of;  ///< their strands
  std::vector<SheetDrawing> m_sheets;
  std::vector<MembraneDrawing> m_membranes;
  std::vector<PouchDrawing> m_pouches;
  std::vector<std::size_t> m_membrane_of, m_pouch_of;  ///< their numbers in the Model
  std::vector<BondDrawing> m_bonds;
  std::vector<BondVeils> m_veils;
  std::vector<BreachDrawing> m_breaches;
  std::vector<MarkDrawing> m_marks;
  std::vector<DrawnVessels> m_vessels;
  std::vector<const Look*> m_vessel_look;
  /// What never moves.
  struct Fixed {
    RigidMesh mesh;
    Detail detail;
  };
  Fixed fixed(const MeshBuffer& shape, const std::string& part, render::Backend& backend) const;

  std::vector<OwnedMesh> m_walls;
  std::vector<Fixed> m_aprons, m_far_aprons;  ///< far: on the cavity
  std::vector<MeshBuffer> m_apron_shapes, m_far_apron_shapes;
  std::vector<std::size_t> m_apron_on;  ///< walls
  DripStains m_stains;                  ///< on the aprons
  std::vector<LiverDome> m_livers;
  std::vector<Porta> m_portas;
  std::vector<RawBed> m_beds;
  MeshBuffer m_cavity_shape;
  RigidMesh m_cavity;
  BowelLoops m_bowel;
  std::optional<Fixed> m_loops, m_large_loop, m_lobe;
  struct Details {  ///< of what is numbered as above
    std::vector<Detail> organs, cuttables, fat, drapes, tubes, joints, ridges, sheets, membranes, pouches, vessels,
        walls;
    Detail cavity, adhesions;
  } m_details;
  std::vector<BodyId> m_in_jaws;  ///< bodies that are held
};

}  // namespace trocar::view
