// The tables that say which keys an exercise file has: the reader obeys them, and the published schema is written from
// them.
#include <iterator>

#include <trocar/scene/json/like.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {
namespace {

using scene::needed;
using scene::Shape;
namespace keys = scene::keys;

const Shape& step_shape() {
  static const Shape shape{
      "step",
      "What has to be done: a state that lasts (when) or an act (on).",
      {needed(keys::name("step", "its name, each once")),
       needed(keys::text("title", "for people; {n}, {name}, {title}")),
       keys::text("hint", "how it is done; {placeholders} for limits, {key:declare} for the key of the device in use"),
       keys::number("weight", 0, 100, "in the score's quality, default 1"),
       keys::name("for_each", "set: one step an element"),
       keys::any("after", "\"previous\", a step or several: counts only when they are closed"),
       keys::any("needs", "a step or several: counts only when they are done"),
       keys::any("when", "condition: done when it has held for for_s"),
       keys::any("for_s", "how long it must hold: a number or a limit, default hold_s"),
       keys::any("on", "event: done when it happens"), keys::any("missed_when", "condition that closes it for good"),
       keys::any("missed_on", "event that closes it for good"),
       keys::any("undone_when", "condition that opens it again once it was done"),
       keys::flag("optional", "true: it does not count against who leaves it")}};
  return shape;
}

const Shape& error_shape() {
  static const Shape shape{
      "error",
      "What counts as an error, and what it costs. One with the code of common rules makes those stricter.",
      {needed(keys::text("code", "the error's code")), keys::text("name", "two or three words"),
       keys::number("points", 0, 100, "taken from the score"),
       keys::flag("fails", "true: the attempt fails whatever its score"),
       keys::text("meaning", "for people: what happened"), keys::text("hint", "for people: how to avoid it"),
       keys::text("source", "of the penalty: a publication, or \"ours\""),
       keys::name("for_each", "set: one error an element"), keys::any("on", "event: made when it happens"),
       keys::any("when", "condition: made when it has held for for_s, again when it has ceased in between"),
       keys::any("for_s", "how long the condition must hold: a number or a limit, default 0"),
       keys::choice("once_per", {"excursion", "attempt"}, "attempt: never again; default excursion"),
       keys::text("detail", "what results add; {on} is what the act was done to"),
       keys::text("at", "mark of the scene where an error of a condition is shown"),
       keys::texts("implies", "codes that always come with it"), keys::texts("may", "codes that can come with it"),
       keys::texts("leaves", "steps that the act does not complete"), keys::texts("misses", "steps that it closes")}};
  return shape;
}

const Shape& detail_shape() {
  static const Shape shape{
      "detail",
      "A fact that results tell, beside what was clipped and cut. Its arguments stand beside.",
      {needed(keys::name("detail", "its name in results, with the fact's unit")),
       needed(keys::any("value", "a fact with its arguments")), keys::name("for_each", "set: one an element"),
       keys::choice("keep", {"last", "most", "range"}, "default last"),
       keys::any("while", "condition: looked at only while it holds")}};
  return shape;
}

const Shape& later_shape() {
  static const Shape shape{"later error",
                           "An error that cannot be detected yet.",
                           {needed(keys::text("code", "its code")), needed(keys::text("name", "two or three words")),
                            needed(keys::text("needs", "what the simulation lacks for it"))}};
  return shape;
}

const Shape& rehearsed_shape() {
  static const Shape shape{
      "rehearsed anatomy",
      "Choices with which the demonstration came off with one anatomy: what `trocar rehearse` prints.",
      {needed(keys::integer("seed", 0, 2147483647, "of the anatomy")),
       needed(
           keys::any("choices", "list of [moment of choice, way]; where none is named it goes on as it is written"))}};
  return shape;
}

const Shape& score_shape() {
  static const Shape shape{
      "score",
      "Shares of the score; what cannot be told is left out and the rest renormalised.",
      {needed(keys::number("quality", 0, 100, "of the weighted share of steps done")),
       needed(keys::number("time", 0, 100, "of the time, from longest to expert")),
       needed(keys::number("motion", 0, 100, "of the motion against a reference group, as soon as there is one")),
       needed(keys::text("source", "where the shares come from"))}};
  return shape;
}

std::vector<std::string> group_names() { return {std::begin(kGroups), std::end(kGroups)}; }

}  // namespace

const Shape& exercise_shape() {
  static const Shape shape{
      "exercise",
      "What has to be done in a scene, and what counts as done well: docs/reference/exercise_format.md.",
      {keys::text("$schema", "where editors find this kind of file's schema"),
       keys::format(3),
       needed(keys::name("name", "what the command line calls it")),
       keys::text(scene::kLike, "exercise file whose keys stand for those that are not here, relative to this one"),
       needed(keys::text("title", "for people")),
       keys::text("summary", "two or three sentences for who chooses an exercise"),
       keys::integer("order", 0, 1000, "in lists, those with less come first; default 1000"),
       keys::choice("group", group_names(), "where the start screen shows it; default: with other exercises"),
       keys::integer("level", 1, kMostLevel, "1 beginner, 2 intermediate, 3 advanced; default 1"),
       needed(keys::text("scene", "path of the scene file, relative to this one")),
       keys::texts("includes", "files of common rules, relative to this one"),
       keys::any("limits", "the numbers that decide, by name: {\"value\": number or [from, to], \"source\": ...}"),
       keys::any("sets", "what is done several times over, by name: a list of elements, or a pattern"),
       needed(keys::objects("steps", step_shape, 1, "in the order in which they are shown")),
       keys::objects("errors", error_shape, 0, "in the order in which they are told"),
       keys::objects("details", detail_shape, 0, "facts that results tell"),
       keys::objects("later", later_shape, 0, "errors that cannot be detected yet"),
       keys::any("demonstration", "how it is shown: a plan of hand skills"),
       keys::objects("rehearsed", rehearsed_shape, 0, "choices of its demonstration by anatomy; its own only"),
       needed(keys::object("score", score_shape, "how the score is put together")),
       needed(keys::number("hold_s", 0, 10, "a condition of a step counts when it has been true this long")),
       needed(keys::number("expert_s", 1, 36000, "time that earns all points for time")),
       needed(keys::number("longest_s", 1, 36000, "time that earns none")),
       needed(keys::number("pass_mark", 0, 100, "score needed")),
       keys::texts("sources", "the publications that are named")}};
  return shape;
}

const Shape& common_rules_shape() {
  static const Shape shape{"common rules",
                           "Limits, steps and errors that exercises include; errors and limits they may make stricter.",
                           {keys::text("$schema", "where editors find this kind of file's schema"), keys::format(3),
                            needed(keys::text("title", "for people")),
                            keys::any("limits", "as of an exercise, with the way in which each is stricter"),
                            keys::any("sets", "as of an exercise; an exercise may have its own instead"),
                            keys::objects("steps", step_shape, 0, "as of an exercise, before its own; default none"),
                            keys::objects("errors", error_shape, 0, "as of an exercise, default none"),
                            keys::texts("sources", "the publications that are named")}};
  return shape;
}

}  // namespace trocar::training
