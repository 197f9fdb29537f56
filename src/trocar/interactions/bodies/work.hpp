// What a tick works out about each body: a record a body. Scratch: nothing of it outlives the tick.
#pragma once

#include <array>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/models.hpp>
#include <trocar/interactions/bodies/sheet_view.hpp>
#include <trocar/tissue/membrane/leak.hpp>

namespace trocar::interactions {

/// Of an organ, whatever it is made of.
struct OrganWork {
  const tissue::Skin* skin = nullptr;  ///< of the Model, or of its TetrahedralWork
  tissue::SkinPose pose;
  tissue::NodeView nodes;  ///< of the State
  NetworkLoads loads;
  std::vector<tissue::ScarredSpring> scars;  ///< those of this tick
  tissue::StepReport report;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("skin", s.skin, core::kMadeOnce), v("pose", s.pose), v("nodes", s.nodes), v("loads", s.loads),
        v("scars", s.scars), v("report", s.report);
  }
};

struct TetrahedralWork {
  tissue::CuttableWork body;
  tissue::CuttableSkin skin;  ///< with what cuts have made of it

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("skin", s.skin);
  }
};

struct StrandBodyWork {
  StrandLoads loads;
  tissue::StrandWork body;
  std::array<tissue::StrandEnd, 2> ends;
  std::array<tissue::StrandReaction, 2> end_reactions;
  tissue::StepReport report;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("loads", s.loads), v("body", s.body), v("ends", s.ends), v("end_reactions", s.end_reactions),
        v("report", s.report);
  }
};

struct MembraneBodyWork {
  tissue::SkinPose pose;
  SheetView sheet;
  NetworkLoads loads;
  std::vector<tissue::ScarredSpring> scars;  ///< those of this tick
  tissue::MembraneWork body;
  std::vector<tissue::BorderPull> pulls;  ///< (held nodes)
  std::vector<Vec3d> targets;             ///< (held nodes)
  tissue::Leak by_wall, by_duct;          ///< of this tick
  tissue::StepReport report;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("pose", s.pose), v("sheet", s.sheet), v("loads", s.loads), v("scars", s.scars), v("body", s.body),
        v("pulls", s.pulls), v("targets", s.targets), v("by_wall", s.by_wall), v("by_duct", s.by_duct),
        v("report", s.report);
  }
};

/// In the order of BodyModels.
struct BodyWork {
  std::vector<OrganWork> organs;
  std::vector<tissue::NetworkWork> solids;
  std::vector<TetrahedralWork> cuttables;
  std::vector<StaticOrganWork> statics;
  std::vector<StrandBodyWork> strands;
  std::vector<MembraneBodyWork> membranes;
  std::vector<FatBodyWork> fat;
  std::vector<Surface> surfaces;  ///< (organs, walls)
};

/// @param scars  how many springs of a body heat may change
BodyWork make_work(const BodyModels& models, std::size_t walls, std::size_t scars);

}  // namespace trocar::interactions
