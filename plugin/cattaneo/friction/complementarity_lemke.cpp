#include <cattaneo/friction/complementarity.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// Gives nodes in contact without friction, which cannot stick, a state of slip in the sense of
/// the displacements x. False if the equations are singular.
bool let_slip(StateEquations &equations, const VectorXd &x)
{
   std::vector<NodeState> states = equations.states();
   for (Index i = 0; i < equations.nodes(); ++i)
   {
      if (closed(states[i]) && equations.frictionless(i))
      {
         states[i] = equations.frictionless_contact(i, x);
      }
   }
   return equations.set(states);
}

/// The path of solutions from a chosen start to the problem's b, see solve_by_lemke().
class Lemke
{
public:
   Lemke(StateEquations &equations, const ComplementarityProblem &problem, const VectorXd &x,
         const VectorXd &F, double slack, unsigned seed);

   bool follow(ComplementarityReport &report);

private:
   /// Inequalities of a node; each has a partner that is an equation while this one is strict.
   /// "a >= 0, with b" says that b is the partner of a.
   enum Kind
   {
      gap,      ///< x_n >= 0, with p
      pressure, ///< p >= 0, with x_n
      forward,  ///< q + f p + θ h >= 0, with forward slip
      backward, ///< f p - q + θ h >= 0, with backward slip
      way,      ///< ± x_t >= 0, with one of the two above
      below,    ///< p >= start of the piece of its bound; partner: the piece below
      above     ///< p <= end of the piece; partner: the piece above
   };
   /// The line of a bound that bends, between two pressures.
   struct Piece
   {
      FrictionBound line;
      double begin = -infinity, end = infinity;
   };
   static constexpr double infinity = std::numeric_limits<double>::infinity();

   template <class Visitor>
   void for_each_inequality(Index i, Visitor visit) const;
   /// The left-hand side. `one` is 1, or 0 for its rate with x, F and θ.
   double value(Index i, Kind kind, const VectorXd &x, const VectorXd &F, double theta,
                double one = 1) const;
   bool bends(Index i) const { return !bounds_.empty() && bounds_[i].bends(); }
   void set_out_from(Index i, const std::function<double()> &some);
   void set_piece(Index i, double p);
   bool exchange(Index i, Kind kind);
   static Kind partner(Kind kind, double sense);
   VectorXd intercepts() const;
   bool find_direction();
   bool meets_all(const VectorXd &x, const VectorXd &F);
   bool go(double direction, double &theta, Index &node, Kind &kind);

   StateEquations &equations_;
   const ComplementarityProblem &problem_;
   const Index n_;
   const bool tangential_;
   const std::vector<FrictionBound> &bounds_; // empty: those of the equations
   std::vector<Piece> pieces_;                // of these
   /// Sense of slip. For nodes in contact it is that of their state. Nodes in separation have
   /// one too while the artificial term θ h acts as their friction; 0 means that they stick.
   VectorXd sense_;
   VectorXd h_;
   VectorXd x_, F_, away_; // b + θ away, θ = 1 at the start
   VectorXd dx_, dF_;      // by dθ
   bool possible_ = true;  // are the equations regular with the pieces at the start?
};

Lemke::Lemke(StateEquations &equations, const ComplementarityProblem &problem,
             const VectorXd &x, const VectorXd &F, double slack, unsigned seed)
   : equations_(equations), problem_(problem), n_(equations.nodes()),
     tangential_(equations.tangential()), bounds_(problem.bounds), pieces_(bounds_.size()),
     sense_(VectorXd::Zero(n_)), h_(VectorXd::Zero(n_)), x_(x), F_(F)
{
   std::mt19937_64 random(seed);
   double largest = std::max(problem.b.cwiseAbs().maxCoeff(), F.cwiseAbs().maxCoeff());
   if (largest == 0) { largest = 1; }
   const auto some = [&]
   { return slack * largest * (0.5 + std::ldexp(double(random() >> 11), -53)); };
   for (Index i = 0; i < n_; ++i) { set_out_from(i, some); }
   away_ = F_ - problem.b - equations.stiffness() * x_;
   // From here on the equations have the slopes of the pieces.
   const std::vector<NodeState> states = equations.states();
   possible_ = bounds_.empty() || equations.set(states);
}

/// Moves x and F of a node so that every inequality is met with a margin, and every equation
/// exactly.
void Lemke::set_out_from(Index i, const std::function<double()> &some)
{
   const NodeState state = equations_.states()[i];
   const VectorXd &stiffness = equations_.diagonal();
   const Index m = equations_.normal_row(i);
   const Choice choice = problem_.choice[i];
   // 1. Gap and pressure.
   if (closed(state)) { x_[m] = 0; }
   else { F_[m] = 0; }
   if (choice == Choice::any)
   {
      if (closed(state)) { F_[m] = std::max(F_[m], 0.0) + some(); }
      else { x_[m] = std::max(x_[m], 0.0) + some() / stiffness[m]; }
   }
   if (!tangential_) { return; }
   if (bends(i)) { set_piece(i, F_[m]); }
   // 2. A shear beyond the bound, which vanishes on the way.
   sense_[i] = sense(state);
   const bool friction_acts = choice == Choice::any && !equations_.frictionless(i);
   if (friction_acts)
   {
      h_[i] = some();
      if (!closed(state)) { sense_[i] = x_[i] >= 0 ? 1 : -1; }
   }
   const auto bound = [&](double sense)
   {
      const FrictionBound &of = bends(i) ? pieces_[i].line : equations_.bound()[i];
      return of.line(F_[m], sense) + h_[i];
   };
   // 3. Slip and friction.
   if (state == NodeState::stick)
   {
      x_[i] = 0;
      if (choice == Choice::any)
      {
         F_[i] = std::clamp(F_[i], -0.9 * bound(1), 0.9 * bound(-1));
      }
      if (choice == Choice::forward) { F_[i] = std::max(F_[i], -bound(1)) + some(); }
      if (choice == Choice::backward) { F_[i] = std::min(F_[i], bound(-1)) - some(); }
      return;
   }
   F_[i] = -sense_[i] * bound(sense_[i]);
   if (friction_acts || choice == Choice::forward || choice == Choice::backward)
   {
      x_[i] = sense_[i] * (std::max(sense_[i] * x_[i], 0.0) + some() / stiffness[i]);
   }
}

/// The piece of a bound at a pressure; at a bend the one below it.
void Lemke::set_piece(Index i, double p)
{
   // If p is at a bend, the piece ends there.
   const double inside = std::nextafter(p, -infinity);
   pieces_[i] = {bounds_[i].straight(p), bounds_[i].bend(inside, -1), bounds_[i].bend(p, 1)};
   equations_.set_bound(i, bounds_[i].of_rates(p));
}

template <class Visitor>
void Lemke::for_each_inequality(Index i, Visitor visit) const
{
   const Choice choice = problem_.choice[i];
   const bool any = choice == Choice::any;
   if (!any && choice != Choice::forward && choice != Choice::backward) { return; }
   const bool in_contact = closed(equations_.states()[i]);
   if (any) { visit(in_contact ? pressure : gap); }
   if (equations_.frictionless(i)) { return; }
   if (in_contact && bends(i))
   {
      if (std::isfinite(pieces_[i].begin)) { visit(below); }
      if (std::isfinite(pieces_[i].end)) { visit(above); }
   }
   if (sense_[i] != 0)
   {
      visit(way);
      return;
   }
   if (choice != Choice::backward) { visit(forward); }
   if (choice != Choice::forward) { visit(backward); }
}

double Lemke::value(Index i, Kind kind, const VectorXd &x, const VectorXd &F, double theta,
                    double one) const
{
   const Index m = equations_.normal_row(i);
   const auto reserve = [&](double sense)
   {
      const double intercept = bends(i) ? pieces_[i].line.intercept(0, sense) : 0.0;
      return equations_.bound()[i].reserve(F[i], F[m], sense) + one * intercept + theta * h_[i];
   };
   switch (kind)
   {
   case gap:
      return equations_.diagonal()[m] * x[m];
   case pressure:
      return F[m];
   case forward:
      return reserve(1);
   case backward:
      return reserve(-1);
   case way:
      return equations_.diagonal()[i] * sense_[i] * x[i];
   case below:
      return F[m] - one * pieces_[i].begin;
   case above:
      return one * pieces_[i].end - F[m];
   }
   return 0;
}

/// The partner: the inequality that is strict while this one is an equation.
Lemke::Kind Lemke::partner(Kind kind, double sense)
{
   switch (kind)
   {
   case gap:
      return pressure;
   case pressure:
      return gap;
   case forward:
   case backward:
      return way;
   case way:
      return sense > 0 ? forward : backward;
   case below:
      return above;
   case above:
      return below;
   }
   return gap;
}

/// The inequality becomes an equation, and its partner an inequality.
bool Lemke::exchange(Index i, Kind kind)
{
   const bool in_contact = closed(equations_.states()[i]);
   if (kind == below || kind == above)
   {
      set_piece(i, kind == below ? pieces_[i].begin : std::nextafter(pieces_[i].end, infinity));
      return equations_.set(i, equations_.states()[i]);
   }
   const bool stays_closed = kind == gap || (kind != pressure && in_contact);
   if (kind == gap && bends(i)) { set_piece(i, 0); }
   if (kind == forward) { sense_[i] = 1; }
   if (kind == backward) { sense_[i] = -1; }
   if (kind == way) { sense_[i] = 0; }
   if (!stays_closed)
   {
      return equations_.set(i, NodeState::separation,
                            !equations_.frictionless(i) && sense_[i] == 0);
   }
   if (equations_.frictionless(i))
   {
      return equations_.set(i, equations_.frictionless_contact(i, x_));
   }
   return equations_.set(i, sense_[i] > 0   ? NodeState::forward_slip
                            : sense_[i] < 0 ? NodeState::backward_slip
                                            : NodeState::stick);
}

bool Lemke::find_direction()
{
   VectorXd b = away_;
   if (tangential_) { b.head(n_) += sense_.cwiseProduct(h_); }
   if (!equations_.solve(b, dx_, dF_)) { return false; }
   if (tangential_) { dF_.head(n_) -= sense_.cwiseProduct(h_); }
   return true;
}

/// Intercepts of the pieces of nodes that slip (the part of the bound that does not grow with
/// p), with the sense of their slip.
VectorXd Lemke::intercepts() const
{
   VectorXd constant = VectorXd::Zero(problem_.b.size());
   for (Index i = 0; i < static_cast<Index>(pieces_.size()); ++i)
   {
      const NodeState state = equations_.states()[i];
      const double way = closed(state) ? sense(state) : 0;
      if (way != 0) { constant[i] = way * pieces_[i].line.intercept(0, way); }
   }
   return constant;
}

bool Lemke::meets_all(const VectorXd &x, const VectorXd &F)
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

/// Goes to the first inequality that becomes an equation, or to θ = 0 if that comes first.
/// False if neither comes, which is a ray.
bool Lemke::go(double direction, double &theta, Index &node, Kind &kind)
{
   double step = direction < 0 ? theta : infinity;
   node = -1;
   for (Index i = 0; i < n_; ++i)
   {
      for_each_inequality(i,
                          [&](Kind k)
                          {
                             const double rate = direction * value(i, k, dx_, dF_, 1, 0);
                             if (!(rate < 0)) { return; }
                             const double to =
                                std::max(value(i, k, x_, F_, theta), 0.0) / -rate;
                             if (to >= step) { return; }
                             step = to;
                             node = i;
                             kind = k;
                          });
   }
   if (!std::isfinite(step)) { return false; }
   x_ += direction * step * dx_;
   F_ += direction * step * dF_;
   theta += direction * step;
   return true;
}

bool Lemke::follow(ComplementarityReport &report)
{
   double theta = 1, direction = -1;
   if (!possible_ || !find_direction()) { return false; }
   const long max_pivots = 20 * n_ + 100;
   while (report.pivots < max_pivots)
   {
      // 1. As far as the present states and pieces hold.
      Index node;
      Kind kind = gap;
      if (!go(direction, theta, node, kind)) { return false; }
      if (node < 0) { break; } // arrived
      // 2. One node changes its state or piece.
      ++report.pivots;
      const Kind to = partner(kind, sense_[node]);
      if (!exchange(node, kind) || !find_direction()) { return false; }
      // 3. The path continues such that the partner's inequality becomes strict, if necessary
      // backwards.
      direction = value(node, to, dx_, dF_, 1, 0) > 0 ? 1 : -1;
   }
   // 4. Solve the equations of the final states once more, without accumulated errors. Nodes in
   // separation now have no artificial friction.
   const std::vector<NodeState> states = equations_.states();
   if (!equations_.set(states)) { return false; }
   const VectorXd constant = intercepts();
   if (!equations_.solve(problem_.b + constant, report.x, report.F)) { return false; }
   report.F -= constant;
   return let_slip(equations_, report.x) && meets_all(report.x, report.F);
}

} // namespace

ComplementarityReport solve_by_lemke(StateEquations &equations,
                                     const ComplementarityProblem &problem, const VectorXd &x,
                                     const VectorXd &F, double slack, unsigned seed)
{
   ComplementarityReport report;
   report.solved =
      let_slip(equations, x) && Lemke(equations, problem, x, F, slack, seed).follow(report);
   return report;
}

} // namespace cattaneo
