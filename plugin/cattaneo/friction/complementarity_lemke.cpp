#include <cattaneo/friction/complementarity.hpp>
#include <cmath>
#include <limits>
#include <random>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// Without friction there is no stick: the states of such nodes in contact, after the
/// displacements x. False if the equations are singular.
bool let_slip(StateEquations &equations, const VectorXd &x)
{
   std::vector<NodeState> states = equations.states();
   for (Index i = 0; i < equations.nodes(); ++i)
   {
      if (closed(states[i]) && equations.smooth(i))
      {
         states[i] = equations.smooth_contact(i, x);
      }
   }
   return equations.set(states);
}

/// The path of solutions from a start of our choice to the problem's b, see solve_by_path().
class Path
{
public:
   Path(StateEquations &equations, const ComplementarityProblem &problem, const VectorXd &x,
        const VectorXd &F, double slack, unsigned seed);

   bool follow(ComplementarityReport &report);

private:
   /// Inequalities of a node; each has a partner that is an equation while this one is strict.
   enum Kind
   {
      gap,      ///< x_n >= 0, with p
      pressure, ///< p >= 0, with x_n
      forward,  ///< q + f p + θ h >= 0, with forward slip
      backward, ///< f p - q + θ h >= 0, with backward slip
      way       ///< ± x_t >= 0, with one of the two above
   };

   template <class Visitor>
   void for_each_inequality(Index i, Visitor visit) const;
   /// The left-hand side, a linear function of x, F and θ.
   double value(Index i, Kind kind, const VectorXd &x, const VectorXd &F, double theta) const;
   bool exchange(Index i, Kind kind);
   bool find_direction();
   bool meets_all(const VectorXd &x, const VectorXd &F);

   StateEquations &equations_;
   const ComplementarityProblem &problem_;
   const Index n_;
   const bool tangential_;
   /// Sense of slip: of nodes in contact that of their state; nodes in separation have one too
   /// as long as θ h holds them, 0 if it does not let them move.
   VectorXd sense_;
   VectorXd h_;
   VectorXd x_, F_, away_; // b + θ away, θ = 1 at the start
   VectorXd dx_, dF_;      // by dθ
};

Path::Path(StateEquations &equations, const ComplementarityProblem &problem, const VectorXd &x,
           const VectorXd &F, double slack, unsigned seed)
   : equations_(equations), problem_(problem), n_(equations.nodes()),
     tangential_(equations.tangential()), sense_(VectorXd::Zero(n_)), h_(VectorXd::Zero(n_)),
     x_(x), F_(F)
{
   std::mt19937_64 random(seed);
   const VectorXd &stiffness = equations.diagonal();
   double largest = std::max(problem.b.cwiseAbs().maxCoeff(), F.cwiseAbs().maxCoeff());
   if (largest == 0) { largest = 1; }
   auto some = [&]
   { return slack * largest * (0.5 + std::ldexp(double(random() >> 11), -53)); };
   // Every inequality is met with something to spare, every equation exactly.
   for (Index i = 0; i < n_; ++i)
   {
      const NodeState state = equations.states()[i];
      const Index m = equations_.normal_row(i);
      const Choice choice = problem.choice[i];
      if (closed(state)) { x_[m] = 0; }
      else { F_[m] = 0; }
      if (choice == Choice::any)
      {
         if (closed(state)) { F_[m] = std::max(F_[m], 0.0) + some(); }
         else { x_[m] = std::max(x_[m], 0.0) + some() / stiffness[m]; }
      }
      if (!tangential_) { continue; }
      sense_[i] = sense(state);
      const bool friction_acts = choice == Choice::any && !equations_.smooth(i);
      if (friction_acts)
      {
         h_[i] = some();
         if (!closed(state)) { sense_[i] = x_[i] >= 0 ? 1 : -1; }
      }
      const auto bound = [&](double sense)
      { return equations_.bound()[i].line(F_[m], sense) + h_[i]; };
      if (state == NodeState::stick)
      {
         x_[i] = 0;
         if (choice == Choice::any)
         {
            F_[i] = std::clamp(F_[i], -0.9 * bound(1), 0.9 * bound(-1));
         }
         if (choice == Choice::forward) { F_[i] = std::max(F_[i], -bound(1)) + some(); }
         if (choice == Choice::backward) { F_[i] = std::min(F_[i], bound(-1)) - some(); }
         continue;
      }
      F_[i] = -sense_[i] * bound(sense_[i]);
      if (friction_acts || choice == Choice::forward || choice == Choice::backward)
      {
         x_[i] = sense_[i] * (std::max(sense_[i] * x_[i], 0.0) + some() / stiffness[i]);
      }
   }
   away_ = F_ - problem.b - equations.stiffness() * x_;
}

template <class Visitor>
void Path::for_each_inequality(Index i, Visitor visit) const
{
   const Choice choice = problem_.choice[i];
   const bool any = choice == Choice::any;
   if (!any && choice != Choice::forward && choice != Choice::backward) { return; }
   if (any) { visit(closed(equations_.states()[i]) ? pressure : gap); }
   if (equations_.smooth(i)) { return; }
   if (sense_[i] != 0)
   {
      visit(way);
      return;
   }
   if (choice != Choice::backward) { visit(forward); }
   if (choice != Choice::forward) { visit(backward); }
}

double Path::value(Index i, Kind kind, const VectorXd &x, const VectorXd &F, double theta) const
{
   const Index m = equations_.normal_row(i);
   switch (kind)
   {
   case gap:
      return equations_.diagonal()[m] * x[m];
   case pressure:
      return F[m];
   case forward:
      return equations_.bound()[i].reserve(F[i], F[m], 1) + theta * h_[i];
   case backward:
      return equations_.bound()[i].reserve(F[i], F[m], -1) + theta * h_[i];
   case way:
      return equations_.diagonal()[i] * sense_[i] * x[i];
   }
   return 0;
}

/// The inequality becomes an equation, and its partner an inequality.
bool Path::exchange(Index i, Kind kind)
{
   const bool in_contact = closed(equations_.states()[i]);
   const bool stays_closed = kind == gap || (kind != pressure && in_contact);
   if (kind == forward) { sense_[i] = 1; }
   if (kind == backward) { sense_[i] = -1; }
   if (kind == way) { sense_[i] = 0; }
   if (!stays_closed)
   {
      return equations_.set(i, NodeState::separation, !equations_.smooth(i) && sense_[i] == 0);
   }
   if (equations_.smooth(i)) { return equations_.set(i, equations_.smooth_contact(i, x_)); }
   return equations_.set(i, sense_[i] > 0   ? NodeState::forward_slip
                            : sense_[i] < 0 ? NodeState::backward_slip
                                            : NodeState::stick);
}

bool Path::find_direction()
{
   VectorXd b = away_;
   if (tangential_) { b.head(n_) += sense_.cwiseProduct(h_); }
   if (!equations_.solve(b, dx_, dF_)) { return false; }
   if (tangential_) { dF_.head(n_) -= sense_.cwiseProduct(h_); }
   return true;
}

bool Path::meets_all(const VectorXd &x, const VectorXd &F)
{
   const VectorXd round_off = 100 * equations_.round_off(problem_.b, x);
   bool met = true;
   for (Index i = 0; i < n_; ++i)
   {
      const double tiny = std::max(round_off[i], round_off[equations_.normal_row(i)]);
      for_each_inequality(i, [&](Kind k) { met = met && value(i, k, x, F, 0) >= -tiny; });
   }
   return met;
}

bool Path::follow(ComplementarityReport &report)
{
   double theta = 1, direction = -1;
   if (!find_direction()) { return false; }
   const long max_pivots = 20 * n_ + 100;
   while (report.pivots < max_pivots)
   {
      double step = direction < 0 ? theta : std::numeric_limits<double>::infinity();
      Index node = -1;
      Kind kind = gap;
      for (Index i = 0; i < n_; ++i)
      {
         for_each_inequality(i,
                             [&](Kind k)
                             {
                                const double rate = direction * value(i, k, dx_, dF_, 1);
                                if (!(rate < 0)) { return; }
                                const double here =
                                   std::max(value(i, k, x_, F_, theta), 0.0) / -rate;
                                if (here >= step) { return; }
                                step = here;
                                node = i;
                                kind = k;
                             });
      }
      if (!std::isfinite(step)) { return false; } // a ray
      x_ += direction * step * dx_;
      F_ += direction * step * dF_;
      theta += direction * step;
      if (node < 0) { break; } // arrived
      ++report.pivots;
      // The path goes on into the inside of the partner's inequality, or turns back to do so.
      const Kind partner = kind == gap          ? pressure
                           : kind == pressure   ? gap
                           : kind != way        ? way
                           : sense_[node] > 0.0 ? forward
                                                : backward;
      if (!exchange(node, kind) || !find_direction()) { return false; }
      direction = value(node, partner, dx_, dF_, 1) > 0 ? 1 : -1;
   }
   // The equations of the final states leave no drift; nothing holds nodes in separation now.
   const std::vector<NodeState> states = equations_.states();
   return equations_.set(states) && equations_.solve(problem_.b, report.x, report.F) &&
          let_slip(equations_, report.x) && meets_all(report.x, report.F);
}

} // namespace

ComplementarityReport solve_by_path(StateEquations &equations,
                                    const ComplementarityProblem &problem, const VectorXd &x,
                                    const VectorXd &F, double slack, unsigned seed)
{
   ComplementarityReport report;
   report.solved =
      let_slip(equations, x) && Path(equations, problem, x, F, slack, seed).follow(report);
   return report;
}

} // namespace cattaneo
