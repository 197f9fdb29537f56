// What objects look like: a class a kind of object (interactions/objects/object_kinds.hpp), and the list of them.
#pragma once

#include <tuple>

#include <trocar/view/objects/bag_drawing.hpp>
#include <trocar/view/objects/fat_drawing.hpp>
#include <trocar/view/objects/rigid_drawing.hpp>
#include <trocar/view/objects/suture_drawing.hpp>

namespace trocar::view {

class ObjectDrawings {
 public:
  ObjectDrawings(const sim::Model& model, render::Backend& backend)
      : m_all(RigidDrawing(model, backend), FatDrawing(model, backend), BagDrawing(model, backend),
              SutureDrawing(model, backend)) {}

  void update(const sim::State& state) {
    std::apply([&](auto&... kind) { (kind.update(state), ...); }, m_all);
  }
  /// @param first  the number of the first object's part
  void list(std::size_t first, const Listing& to) {
    std::apply([&](auto&... kind) { ((kind.list(first, to), first += kind.count()), ...); }, m_all);
  }

 private:
  std::tuple<RigidDrawing, FatDrawing, BagDrawing, SutureDrawing> m_all;
};

}  // namespace trocar::view
