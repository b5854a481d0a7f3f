// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/random_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/support/random.h"

namespace rayshade {
namespace {

class Author : private Random {
 public:
  explicit Author(std::uint64_t seed) : Random(seed + 1), aligned_(chance(0.3)), moves_(chance(0.2)) {}

  std::string write() {
    head();
    air();
    lights();
    surfaces();
    if (chance(0.8))
      statement("plane " + surfaceName() + " 0 0 -2 " + (chance(0.7) ? "0 0 1" : number(-1, 1) + " .2 1") +
                texture());
    const int definitions = below(3);
    for (int i = 0; i < definitions; ++i) {
      const std::string body = object(2);
      statement("name d" + std::to_string(definitions_) + " " + body);
      ++definitions_;
    }
    const int objects = 3 + below(8);
    for (int i = 0; i < objects; ++i) {
      const std::string one = object(3);
      statement(one);
      if (chance(0.1)) statement(one);  // in the same place once more
    }
    if (chance(0.2)) statement("plane " + surfaceName() + " 0 4 0  0 -1 0" + texture());
    return text_;
  }

 private:
  // ---- words

  std::string number(double low, double high) {
    double value = real(low, high);
    if (aligned_) value = std::min(std::max(std::round(2 * value) / 2, low), high);
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.5g", value);
    return buffer;
  }
  std::string share() {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.3g", real());
    return buffer;
  }
  std::string vector(double low, double high) {
    return number(low, high) + " " + number(low, high) + " " + number(low, high);
  }
  std::string color() { return share() + " " + share() + " " + share(); }
  void statement(const std::string& line) { text_ += line + "\n"; }

  // ---- the settings

  void head() {
    statement(pick({"screen 16 12", "screen 24 18", "screen 32 24"}));
    statement("eyep " + number(-2, 2) + " -9 " + number(0, 3) + " lookp " + number(-1, 1) + " 0 0 fov 40");
    statement("sample " + pick<std::string>({"1 nojitter", "1 jitter", "2 jitter", "2 nojitter"}));
    statement("maxdepth " + std::to_string(2 + below(4)));
    if (chance(0.3)) statement("background " + color());
    if (chance(0.2)) statement("filter gauss");
    if (chance(0.1)) statement("aperture .2 focaldist 8");
    if (chance(0.2)) statement("shadowtransp");
    if (chance(0.2)) statement("cutoff .05");
    if (moves_) statement("shutter .5 starttime .25");
  }
  void air() {
    if (!chance(0.25)) return;
    std::string line = chance(0.5) ? "atmosphere" : "atmosphere 1";
    if (chance(0.6)) line += " fog " + color() + " 20 25 30";
    if (chance(0.4)) line += " mist " + color() + " 10 10 12 0 1";
    if (chance(0.4)) line += " fogdeck 1 .5 1 1 1 .5 3 " + color() + " 10 10 10";
    statement(line);
  }
  void lights() {
    const int count = below(4);
    for (int i = 0; i < count; ++i) {
      std::string line = "light " + (chance(0.5) ? color() : share());
      switch (below(6)) {
        case 0:
          line += " point " + vector(-6, 6);
          break;
        case 1:
          line += " directional " + number(-1, 1) + " -1 2";
          break;
        case 2:
          line += " spot " + number(-4, 4) + " -6 6 0 0 0 2 15 30";
          break;
        case 3:
          line += " extended .5 " + number(-4, 4) + " -6 6";
          break;
        case 4:
          line += " area -3 -4 5  -1 -4 5 2  -3 -2 5 2";
          break;
        default:
          line += " ambient";
          break;
      }
      if (chance(0.2) && line.find("ambient") == std::string::npos) line += " noshadow";
      statement(line);
    }
  }
  void surfaces() {
    for (int i = 0; i < 4; ++i) {
      std::string line = "surface s" + std::to_string(i) + " ambient " + color() + " diffuse " + color();
      if (chance(0.6)) line += " specular " + color() + " specpow " + number(0, 30);
      if (chance(0.4)) line += " reflect " + share();
      if (chance(0.4))
        line += " transp " + share() + " body " + color() + " index " +
                pick<std::string>({"1", "1.5", "1.33", "0.8"});
      if (chance(0.2)) line += " extinct .8";
      if (chance(0.2)) line += " translu " + share() + " " + color() + " 10";
      if (chance(0.1)) line += " noshadow";
      statement(line);
    }
    if (chance(0.3)) statement("applysurf " + surfaceName());
  }

  // ---- objects

  std::string surfaceName() { return "s" + std::to_string(below(4)); }
  std::string surface() { return chance(0.7) ? " " + surfaceName() + " " : " "; }

  std::string solid() {
    switch (below(4)) {
      case 0:
        return "sphere" + surface() + number(0.5, 1.5) + " " + vector(-2, 2);
      case 1:
        return box();
      case 2:
        return "torus" + surface() + number(0.5, 1) + " 0.25 " + vector(-2, 2) + " " + number(-1, 1) + " 0 1";
      default:
        return "blob" + surface() + "0.25 1 1.5 " + vector(-1, 1) + " 1 1.5 " + vector(-1, 1);
    }
  }
  std::string box() {
    const double x = std::round(4 * real() - 2), y = std::round(4 * real() - 2),
                 z = std::round(4 * real() - 2);
    char buffer[96];
    std::snprintf(buffer, sizeof buffer, "%g %g %g %g %g %g", x, y, z, x + 1 + below(2), y + 1 + below(2),
                  z + 1);
    return "box" + surface() + buffer;
  }
  std::string shape() {
    switch (below(12)) {
      case 0:
        return "cylinder" + surface() + number(0.3, 1) + " " + vector(-3, 0) + " " + vector(0.5, 3);
      case 1:
        return "cone" + surface() + number(0.5, 1) + " " + vector(-3, 0) + " 0 " + vector(0.5, 3);
      case 2:
        return "disc" + surface() + number(0.5, 2) + " " + vector(-2, 2) + " 0 " + number(-1, 1) + " 1";
      case 3:
        return "triangle" + surface() + vector(-3, 0) + " " + vector(0.5, 3) + " " + number(-3, 0) + " 3 2";
      case 4:
        return "triangle" + surface() + "-2 0 -1 -.3 -.9 0  2 0 " + number(-1, 0) + " .3 -.9 0  0 " +
               number(0, 1) + " 2 0 -.9 .3";
      case 5:
        return "triangleuv" + surface() + "-2 0 -1 0 -1 0 0 0  2 0 -1 0 -1 0 1 0  0 1 2 0 -1 0 0 1";
      case 6:
        return "polygon" + surface() + "-2 1 -2  2 1 -2  2 1 2  0 1 " + number(-1, 1) + "  -2 1 2";
      case 7:
        return "heightfield" + surface() + "tests/support/hills.hf";
      default:
        return solid();
    }
  }
  std::string object(int depth) {
    std::string body;
    const int kind = below(10);
    if (depth == 0 || kind < 5) {
      body = shape();
    } else if (kind < 7) {
      body = chance(0.5) ? "list" : "grid 3 2 4";
      if (chance(0.2)) body += " applysurf " + surfaceName();
      const int members = 1 + below(4);
      for (int i = 0; i < members; ++i) body += "\n  " + object(depth - 1);
      body += "\nend";
    } else if (kind < 9) {
      body = operation(depth);
    } else if (definitions_ > 0) {
      body = "object" + surface() + "d" + std::to_string(below(definitions_));
    } else {
      body = shape();
    }
    return body + transforms() + texture();
  }
  std::string operation(int depth) {
    std::string body = pick({"union", "difference", "intersect"});
    const bool twice = chance(0.1);  // a solid with itself: every face coincides
    const std::string first = operand(depth - 1);
    body += "\n  " + first;
    for (int others = chance(0.2) ? 3 : 1; others > 0; --others)
      body += "\n  " + (twice ? first : operand(depth - 1));
    return body + "\nend";
  }
  std::string operand(int depth) {
    if (depth > 0 && chance(0.4)) return operation(depth) + transforms();
    if (definitions_ > 0 && chance(0.1))
      return "object d" + std::to_string(below(definitions_)) + transforms();
    if (chance(0.1))
      return "list cylinder 1 0 0 -1 0 0 1 disc 1 0 0 1 0 0 1 disc 1 0 0 -1 0 0 -1 end" + transforms();
    return solid() + transforms();
  }

  // ---- where and how

  std::string transforms() {
    std::string all;
    if (chance(0.5)) all += " translate " + vector(-2, 2);
    if (chance(0.3)) all += " rotate 0 " + number(-1, 1) + " 1 " + (aligned_ ? "90" : number(-180, 180));
    if (chance(0.2)) all += " scale " + pick<std::string>({"1 1 2", "-1 1 1", ".5 .5 .5", "1.5 .7 1"});
    if (chance(0.05)) all += " transform 1 .2 0  0 1 0  .1 0 1";
    if (chance(0.05)) all += " translate 1e5 0 0 rotate 0 0 1 180 translate 1e5 0 0";  // a hinge far away
    if (moves_ && chance(0.3)) all += " translate (time) 0 (linear(0,0,1,.5))";
    return all;
  }
  std::string map() {
    return pick<std::string>({"", " map uv", " map spherical", " map cylindrical", " map planar"});
  }
  std::string texture() {
    if (!chance(0.3)) return "";
    std::string t = " texture ";
    switch (below(16)) {
      case 0:
        t += "checker " + surfaceName();
        break;
      case 1:
        t += "marble";
        break;
      case 2:
        t += "wood";
        break;
      case 3:
        t += "bump .3";
        break;
      case 4:
        t += "blotch .1 " + surfaceName();
        break;
      case 5:
        t += "fbm .3 .5 .8 2 4 .1";
        break;
      case 6:
        t += "fbmbump 0 .4 .8 2 4";
        break;
      case 7:
        t += "gloss .8";
        break;
      case 8:
        t += "cloud 1 .8 2 4 .2 .6 .3";
        break;
      case 9:
        t += "sky 1 .8 2 4 .6 .3";
        break;
      case 10:
        t += "stripe " + surfaceName() + " .2 .1" + map();
        break;
      case 11:
        t += "windy .3 1 1 .2 3 2 .5 .1";
        break;
      case 12:
        t += "mount tests/data/suite/snow.map .2 .3";
        break;
      case 13:
        t += "image tests/data/suite/letter.mtv" + map();
        break;
      case 14:
        t += "image tests/data/suite/spot.mtv component body range 1 0 smooth" + map();
        break;
      default:
        t += "checker " + surfaceName() + " scale .5 .5 .5 rotate 0 0 1 30";
        break;
    }
    if (chance(0.3)) t += " scale " + pick<std::string>({"2 2 2", ".3 .3 1"});
    return t;
  }

  bool aligned_, moves_;
  int definitions_ = 0;
  std::string text_;
};

}  // namespace

std::string randomScene(std::uint64_t seed) { return Author(seed).write(); }

}  // namespace rayshade
