// Which step people are shown next: the first that is open. Steps of one set that follow each other in the file belong
// together; of those the element comes first that somebody works on: it was held, clipped or cut last, or had a step
// done.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <trocar/core/body_id.hpp>

namespace trocar::training {

class Rules;
class Scoreboard;

class Guide {
 public:
  /// Steps of a set, an element after another. @param set  its name; empty: steps that are there once
  struct Block {
    std::string set;
    int first = 0, steps = 0, elements = 1;
  };
  void add(Block block) { m_blocks.push_back(std::move(block)); }
  /// A body that belongs to an element. @param body  as holds number it
  void belongs(BodyId body, const std::string& set, int element, const std::string& name) {
    m_owners.push_back({body, set, element, name});
  }
  bool has_owners() const { return !m_owners.empty(); }

  /// Somebody works on this body. @return the element's name; null: it belongs to none
  const std::string* work_on(BodyId body);
  /// What is known of it without anybody working on it.
  const std::string* owner(BodyId body) const;
  void step_done(int step);

  int current(const Rules& rules, const Scoreboard& board) const;

 private:
  struct Owner {
    BodyId body;
    std::string set;
    int element;
    std::string name;
  };
  struct Focus {
    std::string set;
    int element;
  };
  int focus(const std::string& set) const;
  void turn_to(const std::string& set, int element);

  std::vector<Block> m_blocks;
  std::vector<Owner> m_owners;
  std::vector<Focus> m_focus;  ///< a set at most once
};

}  // namespace trocar::training
