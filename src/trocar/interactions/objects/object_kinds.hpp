// Objects: bodies that bring everything with them: things that are moved and put down, and tissue of a kind of its own.
// A kind of object is a class that brings its model, state, work and all operations with it (rigid.hpp shows which);
// code that handles objects, from the step to the recording, goes through this list. A new kind is its own files, a
// line here and one in core/body_id.hpp, one in scene/objects/object_scenes.hpp and one in
// view/objects/object_drawings.hpp.
#pragma once

#include <trocar/core/fields.hpp>
#include <trocar/core/kind_list.hpp>
#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/objects/bag.hpp>
#include <trocar/interactions/objects/fat.hpp>
#include <trocar/interactions/objects/rigid.hpp>
#include <trocar/interactions/objects/suture.hpp>

namespace trocar::interactions {

using ObjectKinds = core::KindList<Rigid, Fat, Bag, Suture>;

/// All of them, a member a kind, which the kind's part() names. Kinds that a scene lacks are not in its hashes.
struct ObjectModels {
  RigidModels rigid;
  BagModels bags;
  SutureModels sutures;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rigid", s.rigid, core::only_if(!s.rigid.list.empty())), v("bags", s.bags, core::only_if(!s.bags.list.empty())),
        v("sutures", s.sutures, core::only_if(!s.sutures.list.empty()));
  }
};
struct ObjectStates {
  std::vector<RigidState> rigid;
  std::vector<BagState> bags;
  std::vector<SutureState> sutures;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rigid", s.rigid, core::only_if(!s.rigid.empty())), v("bags", s.bags, core::only_if(!s.bags.empty())),
        v("sutures", s.sutures, core::only_if(!s.sutures.empty()));
  }
};
struct ObjectWork {
  RigidWork rigid;
  BagWorks bags;
  SutureWorks sutures;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rigid", s.rigid), v("bags", s.bags), v("sutures", s.sutures);
  }
};

/// Models, states or work of all bodies of a kind.
/// @param all  Model, State or Work of a scene: tissue is in it itself, the rest in its `objects`
template <class K, class All>
auto& part_of(All& all) noexcept {
  if constexpr (K::kIsTissue)
    return K::part(all);
  else
    return K::part(all.objects);
}
template <class K>
const typename K::Models& models_of(const Bodies& bodies) noexcept {
  if constexpr (K::kIsTissue)
    return K::part(bodies.models);
  else
    return K::part(*bodies.objects.models);
}
template <class K>
const typename K::States& states_of(const Bodies& bodies) noexcept {
  if constexpr (K::kIsTissue)
    return K::part(bodies.states);
  else
    return K::part(*bodies.objects.states);
}
template <class K>
typename K::Work& work_of(const Bodies& bodies) noexcept {
  if constexpr (K::kIsTissue)
    return K::part(*bodies.work);
  else
    return K::part(*bodies.objects.work);
}

/// f(kind) of the kind of object that the body is. @return whether it is one
template <class F>
bool visit_object(BodyId body, F&& f) {
  bool found = false;
  ObjectKinds::for_each([&](auto kind) {
    if (body.is(decltype(kind)::kKind)) f(kind), found = true;
  });
  return found;
}
/// f(kind, id) of every object of a Model.
template <class Model, class F>
void visit_objects(const Model& model, F&& f) {
  ObjectKinds::for_each([&](auto kind) {
    using K = decltype(kind);
    for (int i = 0; i < K::count(part_of<K>(model)); ++i) f(kind, BodyId(K::kKind, std::size_t(i)));
  });
}
template <class F>
void visit_objects(const Bodies& bodies, F&& f) {
  ObjectKinds::for_each([&](auto kind) {
    using K = decltype(kind);
    for (int i = 0; i < K::count(models_of<K>(bodies)); ++i) f(kind, BodyId(K::kKind, std::size_t(i)));
  });
}

template <class Model, class State>
void start_objects(const Model& model, State& state) {
  ObjectKinds::for_each([&](auto kind) {
    using K = decltype(kind);
    part_of<K>(state) = K::start(part_of<K>(model));
  });
}
template <class Model, class Work>
void make_object_work(const Model& model, int hands, Work& work) {
  ObjectKinds::for_each([&](auto kind) {
    using K = decltype(kind);
    part_of<K>(work) = K::make_work(part_of<K>(model), hands);
  });
}

}  // namespace trocar::interactions
