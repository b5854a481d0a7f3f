// Lattice noise of three dimensions, the one of rayshade, number for number.
//
// Space is cut into unit cubes.  A hash of a cube's corner gives a value and a gradient; the noise at a point
// mixes the linear functions of the eight corners with the weights s(f) = f^2 (3 - 2f) of the fractions f.
// It repeats every 4096 units, lies in about [-1.05, 1.10], has mean 0 and root mean square 0.25, and is not
// 0 on the lattice.
//
// Sources: Perlin, An Image Synthesizer, SIGGRAPH 1985; for the sums of octaves, Musgrave, Kolb & Mace, The
// Synthesis and Rendering of Eroded Fractal Terrains, SIGGRAPH 1989.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/vec.h"

namespace rayshade {

double noise(Vec3 p);
Vec3 vectorNoise(Vec3 p);  // three components from the same corners; the first is noise(p)

// Octaves above this one are finer than doubles can tell apart; the sums below stop there.
inline constexpr int kMostOctaves = 64;

// The sum of noise(2^i p) / 2^i, and the same of absolute values, for i = 0 .. octaves - 1.
double chaos(Vec3 p, int octaves);
double absoluteChaos(Vec3 p, int octaves);

// Fractional Brownian motion: the sum of omega^i noise(lambda^i p).  lambda is the ratio of the frequencies of
// two octaves, omega that of their amplitudes.
struct Spectrum {
  double hurst = 0.5;  // its power falls like frequency^-(1 + 2 hurst); 1/2 is that of a random walk
  double lambda = 2, omega = 0.5;
  int octaves = 1;
};
Spectrum fractionalSpectrum(double hurst, double lambda, int octaves);

double fractionalMotion(Vec3 p, const Spectrum& spectrum);
Vec3 vectorFractionalMotion(Vec3 p, const Spectrum& spectrum);

template <class Archive>
void serialize(Archive& archive, Spectrum& s) {
  archive(s.hurst, s.lambda, s.omega, s.octaves);
}

}  // namespace rayshade
