// Objects: bodies that bring everything with them: things that are moved and put down, and tissue of a kind of its own.
// A kind of object is a class that brings its model, state, work and all operations with it (rigid.hpp shows which);
// code that handles objects, from the step to the recording, goes through this list. A new kind is its own files, a
// line here and one in core/body_id.hpp, one in scene/objects/object_scenes.hpp and one in
// view/objects/object_drawings.hpp.
#pragma once

#include <trocar/core/fields.hpp>
#include <trocar/core/kind_list.hpp>
#include <trocar/interactions/objects/bag.hpp>
#include <trocar/interactions/objects/fat.hpp>
#include <trocar/interactions/objects/rigid.hpp>
#include <trocar/interactions/objects/suture.hpp>

namespace trocar::interactions {

using ObjectKinds = core::KindList<Rigid, Fat, Bag, Suture>;

/// All of them, a member a kind, which the kind's part() names. Kinds that a scene lacks are not in its hashes.
struct ObjectModels {
  RigidModels rigid;
  FatBodies fat;
  BagModels bags;
  SutureModels sutures;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rigid", s.rigid, core::only_if(!s.rigid.list.empty())), v("fat", s.fat, core::only_if(!s.fat.list.empty())),
        v("bags", s.bags, core::only_if(!s.bags.list.empty())),
        v("sutures", s.sutures, core::only_if(!s.sutures.list.empty()));
  }
};
struct ObjectStates {
  std::vector<RigidState> rigid;
  std::vector<FatBodyState> fat;
  std::vector<BagState> bags;
  std::vector<SutureState> sutures;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rigid", s.rigid, core::only_if(!s.rigid.empty())), v("fat", s.fat, core::only_if(!s.fat.empty())),
        v("bags", s.bags, core::only_if(!s.bags.empty())), v("sutures", s.sutures, core::only_if(!s.sutures.empty()));
  }
};
struct ObjectWork {
  RigidWork rigid;
  FatWorks fat;
  BagWorks bags;
  SutureWorks sutures;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rigid", s.rigid), v("fat", s.fat), v("bags", s.bags), v("sutures", s.sutures);
  }
};

template <class K, class All>
auto& part_of(All& all) noexcept {
  return K::part(all);
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
template <class F>
void visit_objects(const ObjectModels& models, F&& f) {
  ObjectKinds::for_each([&](auto kind) {
    using K = decltype(kind);
    for (int i = 0; i < K::count(part_of<K>(models)); ++i) f(kind, BodyId(K::kKind, std::size_t(i)));
  });
}

inline ObjectStates start_of(const ObjectModels& models) {
  ObjectStates out;
  ObjectKinds::for_each([&](auto kind) {
    using K = decltype(kind);
    part_of<K>(out) = K::start(part_of<K>(models));
  });
  return out;
}
inline ObjectWork make_work(const ObjectModels& models, int hands) {
  ObjectWork out;
  ObjectKinds::for_each([&](auto kind) {
    using K = decltype(kind);
    part_of<K>(out) = K::make_work(part_of<K>(models), hands);
  });
  return out;
}

}  // namespace trocar::interactions
