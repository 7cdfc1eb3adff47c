// How pairs of complex eigenvalues leave the imaginary axis as a parameter moves: one damped pair by its real
// part changing its sign (Hopf), or two undamped ones by meeting (flutter; Seyranian and Mailybaev,
// Multiparameter Stability Theory with Mechanical Applications, 2003, chapter 4). Two eigenvalues that meet
// move like the square root of the parameter, and what rounding leaves of them there has half the digits; the
// discriminant of the two goes through zero smoothly and with all its digits.
#pragma once

#include <complex>
#include <optional>
#include <vector>

namespace flyball {

using Spectrum = std::vector<std::complex<double>>; // 1/s, conjugates included

// Eigenvalues to the right of the axis by more than rounding, which is larger the closer an eigenvalue is to
// another. `families`: the double zeros of directions that nothing resists are in it.
int right_of_axis(const Spectrum& spectrum, bool families);

// What leaves the axis. Eigenvalues above the real axis only.
struct PairCrossing {
  bool coalescence = false; // of undamped pairs: then `at` is where they meet, on the axis
  std::complex<double> at;  // 1/s: the eigenvalue on the unstable side, or where the two meet
  std::size_t cluster = 1;  // eigenvalues that meet: two, or twice as many of equal parts
};

// The crossings that a spectrum on the unstable side of one may come from, with `more` eigenvalues to the
// right than on the other side: those closest to the axis first. Real eigenvalues, which leave through zero,
// are left out.
std::vector<PairCrossing> possible_crossings(const Spectrum& unstable, int more, bool families);

// A smooth function of the parameter that is zero at the crossing and positive on its unstable side: four
// times the mean squared distance of the cluster from its centre (1/s^2; of two, the discriminant), or the
// real part of the eigenvalue next to crossing.at (1/s). Nothing where the spectrum has too few eigenvalues.
std::optional<double> crossing_value(const Spectrum& spectrum, const PairCrossing& crossing);

// The eigenvalue next to `s`. The spectrum must not be empty.
std::complex<double> nearest_eigenvalue(const Spectrum& spectrum, std::complex<double> s);

} // namespace flyball
