// What a scene's picture is made of, and the numbers by which its items, its styles and the frames for research name
// it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <trocar/render/frame/frame.hpp>
#include <trocar/sim/model/model.hpp>
#include <trocar/view/analysis/analysis_drawing.hpp>

namespace trocar::view {

enum class PartGroup { organs, tubes, folds, vessels, walls, instruments, clips, marks, fluids, objects };

/// Something that can be shown in another way than the rest, or not at all.
struct ScenePart {
  std::string name;  ///< as in the scene; "cavity", "clips", "blood and water", ... where it has none there
  PartGroup group;
};
enum class PartStyle : std::uint8_t { shaded, transparent, wireframe, hidden };

/// The number of the first part of each kind, from 1 on; part i of the list has number i + 1.
struct FirstParts {
  std::uint16_t organ = 0, tube = 0, fold = 0, membrane = 0, vessel = 0, wall = 0, tool = 0;
  std::uint16_t cavity = 0, scope = 0, clips = 0, mark = 0, liquid = 0, smoke = 0, object = 0;

  /// Of a body of tissue. 0: it has none.
  std::size_t of(BodyId body) const;
};

struct SceneParts {
  std::vector<ScenePart> list;
  FirstParts first;
  std::uint16_t vessel_kinds = 0;

  /// @param vessel_kinds  their names as parts: "arteries", "veins"
  SceneParts(const sim::Model& model, const std::vector<std::string>& vessel_kinds);

  /// 0: it has none.
  std::uint16_t of(Measured kind, std::size_t i) const;
  bool is_vessel(std::uint16_t part) const { return part >= first.vessel && part < first.vessel + vessel_kinds; }
};

/// Of a part; those beyond the styles' end are shaded.
PartStyle style_of(const std::vector<PartStyle>& styles, std::uint16_t part);
/// Gives the items their parts' styles and takes out what is hidden.
void apply(const std::vector<PartStyle>& styles, render::Frame& frame);

}  // namespace trocar::view
