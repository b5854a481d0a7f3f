// The statements that make objects, and those that may stand beside them in an aggregate: surfaces and names.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/language/argument_reader.h"
#include "rayshade/language/fault_log.h"
#include "rayshade/language/item_writer.h"

namespace rayshade {

class ObjectParser {
 public:
  // `flipNormals`: of the shapes that can turn them.
  ObjectParser(Tokens& tokens, FaultLog& log, SceneSink& sink, ImageLibrary& images, bool flipNormals)
      : tokens_(tokens),
        log_(log),
        items_(sink),
        flipNormals_(flipNormals),
        in_(tokens, surfaces_, images,
            [&log](const TokenPlace& place, const std::string& text) { log.warn(place, text); }) {}

  ArgumentReader& arguments() { return in_; }
  SceneSink& sink() { return items_.sink(); }

  // Takes the keyword only if it begins such a statement.
  bool statement(Word word, Scope& scope);
  // Reads on behind what is wrong, still in the same scope.
  template <class Read>
  void recovering(Scope& scope, const Read& read);

 private:
  // What `name` has defined.
  struct NamedObject {
    DefinitionId id = kWorld;
    bool empty = true;
    bool failed = false;  // said already: its uses are right
    int height = 0;
  };

  void findStatement(const Scope& scope);
  void defineSurface();
  void defineObject(const Scope& scope);
  void instance(Scope& scope);
  void primitive(Scope& scope);
  void namedInstance(Scope& scope);
  void aggregate(Scope& scope);
  void gridSize(Scope& scope);
  void members(Scope& scope, Word opening, const TokenPlace& place);

  Tokens& tokens_;
  FaultLog& log_;
  ItemWriter items_;
  bool flipNormals_;
  SurfaceTable surfaces_;
  NameMap<NamedObject> objects_;
  ArgumentReader in_;
};

template <class Read>
void ObjectParser::recovering(Scope& scope, const Read& read) {
  bool lost = false;
  do {
    try {
      if (lost) {
        findStatement(scope);
      } else {
        read();
      }
      lost = false;
    } catch (const Fault& fault) {
      scope.failed = lost = true;
      items_.silence();
      log_.add(fault);
    }
  } while (lost);
}

}  // namespace rayshade
