#pragma once

#include <cattaneo/friction/march.hpp>
#include <cattaneo/wear/archard.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cattaneo
{

/// The state of a wearing contact: all data on which its future depends.
struct WearState
{
   /// With the slip and the forces of the worn contact, whose gap is g + depth.
   ContactState contact;
   Eigen::VectorXd depth;       ///< worn off at each node, size n, ≥ 0: the gap is g + depth
   Eigen::VectorXd dissipation; ///< energy lost by friction at each node so far, size n
   double cycles = 0;           ///< so far, marched or jumped over
   /// The contact at the end of the last cycle, before its wear was added to the gap. The march
   /// continues from it. Empty: from `contact`.
   std::optional<ContactState> marched = std::nullopt;

   /// Unworn, before any load.
   static WearState virgin(const ReducedProblem &problem);
   /// InputError if it belongs to another problem (its forces do not follow from its
   /// displacements and loads), or if depth or dissipation is negative.
   void validate(const ReducedProblem &problem) const;
};

/// As JSON, to the last bit. InputError as for contact states.
void save(const WearState &state, const std::string &file);
/// Reads what save() wrote.
WearState load_wear_state(const std::string &file);

/// When wear is added to the gap.
enum class GapUpdate
{
   cycle, ///< at the end of each cycle
   piece  ///< at the end of each linear piece of the cycle
};

/// How a contact is worn. The defaults march every cycle.
struct WearSettings
{
   MarchSettings march; ///< of each cycle. Its monitor watches the whole computation and is
                        ///< asked between two cycles. A steady state of slip does not end it
   GapUpdate update = GapUpdate::cycle; ///< when wear is added to the gap
   /** Largest estimated error of the depths because cycles are skipped, at each recorded cycle,
       as a share of the largest depth (see WearReport::error). 0: every cycle is marched, as
       with GapUpdate::piece. Allowed: from 1e-8 to 0.1. */
   double tolerance = 0;
   /// Is the observer called for a cycle or jump between these two numbers of cycles? Empty:
   /// always.
   std::function<bool(double from, double to)> observed;
   /// Wear is final, and the march ends, when a cycle adds less than this share of the largest
   /// depth so far. 0: the march goes on.
   double final_share = 0;
   /// Wear is steady when the depth that a cycle adds has changed, over the last quarter of all
   /// cycles so far, by no more than this share of the largest.
   double steady_tolerance = 1e-6;

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

/// A cycle that was marched, or a jump over several.
struct WearRecord
{
   double cycles = 0;      ///< so far, at its end
   double covered = 1;     ///< how many it covers
   double volume = 0;      ///< worn off so far
   double depth = 0;       ///< largest so far
   double dissipation = 0; ///< energy lost by friction so far
   double loss =
      0; ///< energy lost in the last cycle; after a jump, in a cycle of the worn contact
   double error = 0; ///< estimate of the largest error of depth so far, by all jumps
};

/// The result of a march with wear.
struct WearReport
{
   FrictionStatus status = FrictionStatus::converged; ///< of the whole of it
   std::string message;                               ///< one sentence, empty if converged
   MarchReport last; ///< of the last cycle marched: where and why it ended, if it did
   /// Cycles marched to their end, also those that only look where a jump leads
   long marched = 0;
   long jumps = 0; ///< number of jumps over cycles
   /** Estimate of the largest error of depth at the end that comes from jumps, 0 without jumps.
       It is the largest distance so far between this computation and one whose jumps are twice
       as long, or half of the errors of single jumps if that is more. The errors that both may
       share are added. It includes the growth of errors of early jumps. Infinite: the wear is
       too unstable for an estimate, as `remark` says. */
   double error = 0;
   /// Is the estimated error of depths within WearSettings::tolerance?
   bool reached = true;
   /// A remark if errors of jumps grew, or if no equilibrium was found at the worn gap, so that
   /// the returned contact is that at the end of the last cycle. Empty otherwise.
   std::string remark;
   std::vector<WearRecord> records; ///< of every cycle that was marched and every jump
   /** Largest number of cycles that may share one update of the gap: the explicit update
       depth += cycles × (depth of a cycle) is stable below it. With the loss of pressure δp =
       -C δdepth and the depth of a cycle c p (c a diagonal) it is 2/λ_max(c C). Jumps are
       implicit, without such a limit. The least so far; infinite if nothing wears. */
   double explicit_limit = 0;
   /// Cycles so severe (explicit_limit below 2) that their own update was implicit. k is so
   /// large that one cycle wears off as much as the contact is compressed.
   long implicit_cycles = 0;
   double steady_cycle = 0; ///< first of the cycles with equal wear; 0: none
   double final_cycle = 0;  ///< at which wear ended; 0: it has not ended
   /// Ends of the line that the contact reached in any cycle although the bodies go on there:
   /// the wear is then too small.
   std::vector<CutOffContact> cut_off;
   Counters counters;  ///< of all marches
   double seconds = 0; ///< wall time
};

/// Called after every marched cycle and every jump that WearSettings::observed asks for. Jumps
/// are handed over when their error is known.
using WearObserver = std::function<void(const WearState &, const WearRecord &)>;

/// Called after every marched increment, with the worn depth in its gap. This includes cycles
/// that are marched only to see where a jump leads.
using WornIncrementObserver = std::function<void(const ContactState &, const IncrementRecord &,
                                                 const Eigen::VectorXd &depth)>;

/** Wears a contact: marches the opening part of a history and then its cycle, `cycles` times in
    all (history.cycles is ignored), and adds the wear of each cycle to the gap.

    Every marched cycle is exact along its path, see worn_depth(). If k and f are uniform and
    there is no threshold, the worn volume is k/f times the energy lost by friction, at every
    moment and to round-off. This also holds where cycles are jumped over, because their energy
    is computed from the volume.

    A jump over M cycles solves for the pressures at its end, p' = p - C (M c p' + openings) ≥
    0, which is a contact problem with a layer of compliance M c. It is stable for any M. Jumps
    of one, two and three parts, each with a cycle of its own marched until it repeats itself,
    are extrapolated to parts without length. Two corrections are added: the larger wear by
    updates after each cycle, and the larger wear of a cycle because the gap has changed before
    it. The result without the single jump gives an error, which sets the length of the jump.

    Small errors of early jumps may grow. Two computations therefore run side by side, the
    second with jumps twice as long, and the distance between both is the estimate of the error.
    If it exceeds the tolerance, both begin again at the first jump with shorter jumps, in the
    end with none. A jump is also shortened if it wears more than its number of cycles times the
    largest wear of a marched cycle, or less than that number times the smallest. With
    GapUpdate::piece all cycles are marched.

    The returned states belong to the worn gap: after a jump a cycle is marched there, and after
    a marched cycle the contact settles at the worn gap under the same loads.

    Depth must be small against the contact: frames and weights stay those of the unworn bodies.

    Stops early with the status of the cycle that has no equilibrium, or `stopped`. InputError
    as march(), for a history without a cycle, and for a state that is neither at its beginning
    nor between two cycles. */
WearReport wear(const ReducedProblem &problem, const WearLaw &law, const LoadHistory &history,
                double cycles, WearState &state, const WearSettings &settings = {},
                const WearObserver &observer = {}, const WornIncrementObserver &watch = {});

} // namespace cattaneo
