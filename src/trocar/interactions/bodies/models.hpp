// All tissue of a scene as it is compiled: bodies by kind. What all of them have to do with each other is in
// bodies.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/attachment.hpp>
#include <trocar/interactions/bodies/fat_body.hpp>
#include <trocar/interactions/bodies/static_organ.hpp>
#include <trocar/interactions/bodies/strand_body.hpp>
#include <trocar/tissue/membrane/membrane.hpp>
#include <trocar/tissue/network/prestress.hpp>
#include <trocar/tissue/network/skin.hpp>
#include <trocar/tissue/tets/cuttable.hpp>
#include <trocar/tissue/tets/cuttable_skin.hpp>

namespace trocar::interactions {

/// A volumetric organ.
struct SolidModel {
  std::string name, look, tissue;
  double cell = 0;  ///< lattice edge [m]
  tissue::NetworkModel network;
  std::vector<tissue::Anchor> anchors;  ///< springs to space
  tissue::Skin skin;                    ///< contact and clips
  tissue::Skin fine;                    ///< drawn: the same surface, more vertices
  double failure_strain = 0;            ///< 0: it never tears

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("network", s.network), v("skin", s.skin), v("fine", s.fine), v("failure_strain", s.failure_strain),
        v("anchors", s.anchors), v("name", s.name, core::kNotHashed), v("look", s.look, core::kNotHashed),
        v("tissue", s.tissue, core::kNotHashed), v("cell", s.cell, core::kNotHashed);
  }
};

/// A volumetric organ that can be cut anywhere. Organs are numbered: solids first, then these.
struct CuttableOrgan {
  std::string name, look, tissue;
  double cell = 0;  ///< a typical edge [m]
  tissue::CuttableModel body;
  tissue::CuttableSkin skin;  ///< uncut; what is touched, held and drawn
  double failure_strain = 0;  ///< 0: it never tears

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("failure_strain", s.failure_strain), v("name", s.name, core::kNotHashed),
        v("look", s.look, core::kNotHashed), v("tissue", s.tissue, core::kNotHashed),
        v("cell", s.cell, core::kNotHashed), v("skin", s.skin, core::kNotHashed);
  }
};

/// A stretch of a strand with a name: isthmus, ampulla, fimbria.
struct LandmarkModel {
  std::string name;
  double from = 0, to = 0;  ///< arc length [m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("name", s.name), v("from", s.from), v("to", s.to);
  }
};

/// What holds a strand's end: nothing, space, or an organ.
struct StrandEndModel {
  enum Kind : std::int32_t { free, fixed, hosted } kind = free;
  Attachment on;  ///< of a hosted one: a long row of the organ's nodes

  std::int32_t organ() const noexcept { return kind == hosted ? std::int32_t(on.point.body.index()) : -1; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("kind", s.kind), v("on", s.on);
  }
};

/// A strand as it is known, drawn and held at its ends; what moves is Model::strand_bodies.
struct StrandAnatomy {
  std::string name, look, tissue;
  std::vector<double> outer, inner;  ///< (n) radius and lumen radius at the nodes [m], for drawing and clips
  StrandEndModel start, end;
  std::vector<LandmarkModel> landmarks;
  bool fimbriated = false;
  double failure_strain = 0;  ///< 0: it never tears

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("start", s.start), v("end", s.end), v("failure_strain", s.failure_strain), v("name", s.name, core::kNotHashed),
        v("look", s.look, core::kNotHashed), v("tissue", s.tissue, core::kNotHashed),
        v("outer", s.outer, core::kNotHashed), v("inner", s.inner, core::kNotHashed),
        v("landmarks", s.landmarks, core::kNotHashed), v("fimbriated", s.fimbriated, core::kNotHashed);
  }
};

/// A thin fold with mechanics of its own: its border hangs on a strand, its base on other bodies and on space.
struct MembraneBody {
  std::string name, look, tissue;
  std::int32_t strand = -1;  ///< on row 0
  double from = 0, to = 0;   ///< arc length [m]
  bool cuttable = true;
  tissue::MembraneModel sheet;
  tissue::Skin skin;              ///< the sheet's own nodes and triangles, one skin vertex per node
  double pinch_reach = 0;         ///< of a pouch (SheetView) [m]
  std::vector<float> depth;       ///< (nodes) way from the strand's surface, in the drawn shape [m]
  std::vector<Attachment> holds;  ///< (held nodes)
  double failure_strain = 0;      ///< 0: it never tears
  std::int32_t duct = -1;         ///< of a pouch: the strand whose lumen opens into it; -1: none
  bool duct_at_start = false;     ///< with the strand's beginning; else with its end

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("duct", s.duct, core::only_if(s.duct >= 0)), v("duct_at_start", s.duct_at_start, core::only_if(s.duct >= 0));
    v("sheet", s.sheet), v("skin", s.skin), v("strand", s.strand), v("cuttable", s.cuttable), v("depth", s.depth),
        v("pinch_reach", s.pinch_reach), v("failure_strain", s.failure_strain), v("holds", s.holds),
        v("name", s.name, core::kNotHashed), v("look", s.look, core::kNotHashed),
        v("tissue", s.tissue, core::kNotHashed), v("from", s.from, core::kNotHashed), v("to", s.to, core::kNotHashed);
  }
};

/// A row of W of more nodes than a material point has with it. Weights add up to 1.
struct LongRow {
  std::vector<std::int32_t> node;
  std::vector<float> weight;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("node", s.node), v("weight", s.weight);
  }
};

/// Organs are numbered: lattices first, then what can be cut.
struct BodyModels {
  std::vector<SolidModel> solids;
  std::vector<CuttableOrgan> cuttables;
  std::vector<StaticOrgan> statics;  ///< those of both that are quasi-static
  std::vector<StrandAnatomy> strands;
  std::vector<StrandBody> strand_bodies;  ///< (strands) their mechanics
  std::vector<MembraneBody> membranes;
  std::vector<FatBody> fat;
  std::vector<LongRow> rows;

  int organs() const { return int(solids.size() + cuttables.size()); }
  const tissue::Skin& skin(int organ) const {  ///< in the drawn shape
    const std::size_t i = std::size_t(organ), lattices = solids.size();
    return i < lattices ? solids[i].skin : cuttables[i - lattices].skin.skin;
  }
};

}  // namespace trocar::interactions
