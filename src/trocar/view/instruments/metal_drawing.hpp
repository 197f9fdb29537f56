// All that is not of the body: instruments with their trocars, the endoscope's shaft, clips, and the rods by which
// instruments throw shadows.
#pragma once

#include <map>
#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/analysis/scene_parts.hpp>
#include <trocar/view/base/listing.hpp>
#include <trocar/view/instruments/instrument_shapes.hpp>
#include <trocar/view/instruments/port_site.hpp>

namespace trocar::view {

class MetalDrawing {
 public:
  /// @param cavity  what continues from the model's walls, which trocars may come through, too
  MetalDrawing(const sim::Model& model, const MeshBuffer& cavity, render::Backend& backend);

  void update(const sim::State& state);
  void list_tools(const sim::State& state, const std::vector<PartStyle>& styles, const FirstParts& first,
                  const Listing& to);
  void list_clips(const sim::State& state, const FirstParts& first, const Listing& to);
  void list_port_sites(const FirstParts& first, const Listing& to);
  void list_scope(Vec3d port, const kinematics::FulcrumPose& pose, const FirstParts& first, const Listing& to);

 private:
  /// A rigid part of an instrument and its mesh.
  struct DrawnPart {
    InstrumentPart::Joint joint;
    const Look* look;
    RigidMesh drawn;
    Detail detail;
    int link = 0;
  };
  /// The clip that lies ready in an applier's jaws.
  struct LoadedClip {
    int hand = -1, instrument = -1;  ///< of the hand's rack
    OwnedMesh mesh;
  };
  std::vector<DrawnPart> made(const std::vector<InstrumentPart>& parts, const Detail& detail, render::Backend& backend);
  void make_hand(std::size_t hand, const std::vector<PiercedWall>& pierced, const sim::State& start,
                 render::Backend& backend);
  double drawn_aperture(const sim::State& state, std::size_t hand) const;
  interactions::ToolShape shape_in_trocar(const sim::State& state, std::size_t hand) const;
  void list_hand(const sim::State& state, std::size_t hand, const FirstParts& first, const Listing& to);
  void list_rods(const sim::State& state, std::size_t hand, render::Frame& frame) const;
  void list_loaded(const sim::State& state, std::size_t hand, const FirstParts& first, const Listing& to) const;

  const sim::Model* m_model;
  render::Material m_lining;                                 ///< of the wall around a trocar
  std::vector<std::vector<std::vector<DrawnPart>>> m_tools;  ///< (hands, rack)
  std::vector<std::vector<DrawnPart>> m_sleeves;             ///< (hands)
  std::vector<PortSite> m_port_sites;                        ///< (hands)
  std::vector<Detail> m_port_details;                        ///< (hands)
  std::vector<double> m_sleeve_end, m_sleeve_radius;         ///< (hands) from the port; inside [m]
  std::vector<DrawnPart> m_scope;
  std::vector<LoadedClip> m_loaded;
  std::map<double, RigidMesh> m_clips;  ///< closed ones, by their length [m]
  Detail m_clip_detail;
  const Look* m_titanium;
};

}  // namespace trocar::view
