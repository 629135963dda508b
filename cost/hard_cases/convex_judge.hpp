// Convex judge: what every method says of a pair, held against a truth that no method made.
#pragma once

#include "cost/hard_cases/cases.hpp"
#include "cost/hard_cases/quad_truth.hpp"

#include <optional>

namespace throng {

/// The worst figure of each quantity, method by method, in the order they were met in.
class MethodTally {
public:
    /// The greatest of all figures is the line's; one that is not a number stays.
    void worst(std::string_view method,
               std::string_view setting,
               std::string_view quantity,
               double figure,
               double bound,
               std::string_view unit = "1");
    /// The sum of all figures is.
    void count(std::string_view method,
               std::string_view setting,
               std::string_view quantity,
               double more,
               double bound = 0);
    void report(CaseBench& bench) const;

private:
    struct Line {
        std::string method, setting, quantity, unit;
        double figure = 0, bound = 0;
    };
    Line& line(std::string_view method,
               std::string_view setting,
               std::string_view quantity,
               double bound,
               std::string_view unit);

    std::vector<Line> lines_;
};

/// Two shapes in the world.
///
///   size     m, what errors are told in
///   truth    distance, or minus the depth
///   solid_a, solid_b   polytopes in world axes, seen from a's origin; else normals and points are
///                      not looked at
struct KnownPair {
    ShapeDescription a, b;
    Pose at_a, at_b;
    double size = 1;
    double truth = 0;
    std::optional<QuadSolid> solid_a = std::nullopt, solid_b = std::nullopt;
};

/// A pair of boxes with its truth; size is the greater of their half diagonals.
KnownPair known_boxes(const Vec3& half_a, const Pose& at_a, const Vec3& half_b, const Pose& at_b);

/// What is asked of answers, in the pair's size.
struct AnswerBounds {
    double decided_beyond = 1e-12;  // the verdict is right where they are further apart or deeper
    double value = 1e-9;            // errors of lengths
    int rounds = 0;                 // of a search; 0: any number, as long as the answer is good
};

/// Asks every method that serves the pair both ways round, from every start, and tallies what it
/// claims to tell: verdicts, lengths, normals, points.
void judge(CaseBench& bench,
           MethodTally& tally,
           const KnownPair& pair,
           std::string_view setting,
           const AnswerBounds& bounds = {});

/// Asks a step in float both ways round, and tallies verdicts that are wrong though the two are
/// further apart or deeper than kFloat of their size.
void judge_in_float(CaseBench& bench,
                    MethodTally& tally,
                    const KnownPair& pair,
                    std::string_view setting);

/// How near to touching, of the size, either answer of a step in float is right.
inline constexpr double kFloat = 1e-5;

/// The line's setting for what was asked in float.
std::string in_float(std::string_view setting);

/// Whether a method serves a pair: a polytope is a box or a hull.
bool serves(const MethodDescription& method, const ShapeDescription& a, const ShapeDescription& b);

/// Distance, or minus the depth, if the method tells it; else NaN.
double told_separation(const MethodDescription& method, const ConvexAnswer& answer);

}  // namespace throng
