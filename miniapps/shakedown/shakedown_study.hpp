#pragma once

#include "common/punch.hpp"
#include "common/run.hpp"
#include "common/strength_options.hpp"
#include "common/watch.hpp"

#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/estimates.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <cattaneo/shakedown/monolith.hpp>
#include <cattaneo/shakedown/transient.hpp>
#include <optional>
#include <string>
#include <vector>

namespace miniapp
{

/// The study of the program shakedown: a contact, its stuck state, its limits, and marches to
/// compare.
class Shakedown
{
public:
   explicit Shakedown(Study &study) : study(study), results(study.results) {}
   void run();

private:
   /// The assumption of the limits.
   static constexpr const char *assumption = cattaneo::limit_assumption;

   void options();
   void prepare();
   /// Sets the law of friction of the options, and refuses options that do not go with it.
   void take_law();
   /// The law of friction in words.
   std::string law() const;
   /// Keeps in the problem only the nodes that stay closed in marches at this load.
   void keep_closed(double load_factor);
   /// Computes the data that follow from the problem.
   void set_up();
   /// The limit. If nothing else is requested, it is computed for the nodes that stay closed at
   /// the limit itself.
   void largest_of_closed();
   cattaneo::LoadCycle cycle_of(const cattaneo::ReducedProblem &of, double R) const;
   /// The largest load of a problem, and its smallest friction for the loads. Ctrl-C ends the
   /// study with the bounds that are proven so far.
   cattaneo::LimitReport largest(const cattaneo::LimitProblem &of,
                                 const cattaneo::LimitReport *start = nullptr);
   cattaneo::LimitReport smallest(const cattaneo::LimitProblem &of);
   cattaneo::LimitReport counted(cattaneo::LimitReport report);
   /// Leaves the study.
   [[noreturn]] void stopped(const std::string &message);
   /// Reports a limit with its bounds, and whether it is a limit of the bodies or of the mesh.
   /// `what` is load or friction.
   void report(const std::string &what, const cattaneo::LimitReport &of, double load_factor,
               double f);
   void monolith();
   /// The place between nodes where the ratio of tractions is largest: the maximum of the
   /// parabola through the node with the largest ratio and its neighbours.
   double largest_inside(const cattaneo::Adhesion &at) const;
   /// The load up to which the singular corner needs more friction than any place inside.
   void leave_corner(double opens);
   /// Friction for full adhesion against the load (thesis figure 4.3).
   void draw_adhesion(double opens, const char *by);
   void smallest_friction();
   void method2(double f1);
   /// Tractions of the monolith (thesis figures 4.4 and 4.5), and the steps of the estimates
   /// (4.7 to 4.14) from `f1`, the friction of method 1.
   void draw_monolith();
   void draw_estimates(const cattaneo::Method2Estimate &second, double f1);
   void largest_load();
   /// Largest loads over f of three cycles and frictions of chapter 4.
   void ratios();
   cattaneo::ReducedProblem with_B_transposed() const;
   /// The cycle and the friction of the limit problem.
   void as_before();
   cattaneo::TransientReport counted(cattaneo::TransientReport run);
   cattaneo::TransientSettings of_cycles(Watch &watch) const;
   /// Checks the nodes that are taken to stay open: their gaps at the limit, and marches of the
   /// whole contact in which they are free to close.
   void check_open_nodes();
   /// Reports the proven bound of λ1, if it is requested or costs nothing, and the result of
   /// marches from many starts.
   void lower();
   /// Computes the bound of λ1 that is proven except for slip at nodes near the ends.
   void lower_apart(const cattaneo::LimitSettings &settings);
   Eigen::VectorXd traction(const Eigen::VectorXd &force) const;
   /// The limit whose optimal slip is drawn and marched from.
   const cattaneo::LimitReport &best() const { return find != "load" ? least : most; }
   /// The optimal slip, its residual tractions, and the permissible residual shear with its
   /// pressures (thesis figures 4.15 to 4.17).
   void draw_optimal();
   void marches();
   void limit_map();
   /// The limits of another punch, as a row of a table.
   void repeat(const char *table_name, const PunchOptions &other);

   /// A label: for the punch in units a = P = E' = 1, for a saved problem in its own units.
   const char *of_punch(const char *label, const char *otherwise) const
   {
      return saved ? otherwise : label;
   }

   Study &study;
   nlohmann::ordered_json &results;
   PunchOptions punch;
   double friction = none, lambda_max = 0.8, lambda_min = -0.4, reversal = none, corner = 0.01;
   std::string find = "both", reduced, held = "P", cycled = "Q";
   bool map = false, adhesion = false, march = false, closed = false, steps = false;
   bool transposed = false, load_ratios = false, lower_limits = false;
   int cycles = 200, starts = 0;
   std::vector<double> mesh_study, mismatch, mismatch_poisson;

   std::optional<StrengthOptions> strength;

   bool saved = false;    ///< the contact comes from a file
   bool coulomb = true;   ///< its law of friction is Coulomb's
   bool standard = false; ///< the punch whose reference values are known
   Scene scene;
   cattaneo::ReducedProblem problem; ///< of the nodes that stay closed, if requested
   cattaneo::ReducedProblem whole;   ///< with the others, …
   cattaneo::ReducedProblem gapped;  ///< … and as it was given, with its gap
   cattaneo::ClosedContact part;
   cattaneo::LoadCycle cycle;
   Eigen::VectorXd x;
   cattaneo::NodeList inner; ///< nodes away from the ends
   cattaneo::LimitProblem limit;
   cattaneo::LimitReport least, most;
};

} // namespace miniapp
