#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/friction/methods.hpp>
#include <cattaneo/friction/near_contact.hpp>
#include <cattaneo/input_error.hpp>
#include <numeric>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// With fewer nodes it is as fast to use all of them.
constexpr Index many_nodes = 256;
/// With more eighths too few nodes would be left out.
constexpr int most_eighths = 6;

bool solves(const IncrementReport &report)
{
   return report.status == FrictionStatus::converged ||
          report.status == FrictionStatus::not_unique;
}

double largest_entry(const VectorXd &x)
{
   return x.size() ? x.cwiseAbs().maxCoeff() : 0;
}

} // namespace

FarFirst::FarFirst(const ReducedProblem &problem) : K_(problem.K), rank_(problem.nodes())
{
   const Index n = problem.nodes();
   std::vector<Index> order(n);
   std::iota(order.begin(), order.end(), Index(0));
   std::stable_sort(order.begin(), order.end(),
                    [&](Index a, Index b) { return problem.gap[a] < problem.gap[b]; });
   for (Index k = 0; k < n; ++k) { rank_[order[k]] = k; }
   for (int step = 0; step < 8; ++step)
   {
      std::sort(order.begin() + nodes(7 - step), order.begin() + nodes(8 - step));
      for (Index component = 0; component <= problem.components(); ++component)
      {
         for (Index k = nodes(7 - step); k < nodes(8 - step); ++k)
         {
            rows_.push_back(component * n + order[k]);
         }
      }
      begin_[step + 1] = static_cast<Index>(rows_.size());
   }
}

int FarFirst::eighths(Index nodes) const
{
   return static_cast<int>((8 * nodes + rank_size() - 1) / rank_size());
}

bool FarFirst::leave(int eighths)
{
   for (int step = static_cast<int>(steps_.size()); step < 8 - eighths; ++step)
   {
      const auto first = rows_.begin() + begin_[step], end = rows_.begin() + begin_[step + 1];
      const std::vector<Index> rows(first, end), after(end, rows_.end());
      MatrixXd K = K_(rows, rows);
      Step next;
      next.Y = K_(rows, after);
      for (int k = 0; k < step; ++k)
      {
         // The columns of this step and of those after it.
         const Index before = begin_[step] - begin_[k + 1];
         const auto Y = steps_[k].Y.middleCols(before, K.cols());
         K = minus_square(std::move(K), Y);
         subtract_product(next.Y, Y, steps_[k].Y.rightCols(next.Y.cols()));
      }
      if (!next.factor.compute(std::move(K))) { return false; }
      next.factor.solve_half(next.Y);
      steps_.push_back(std::move(next));
   }
   return true;
}

MatrixXd FarFirst::stiffness(int eighths) const
{
   const std::vector<Index> left(rows_.begin() + before(eighths), rows_.end());
   MatrixXd K = K_(left, left);
   for (int step = 0; step < 8 - eighths; ++step)
   {
      // A compiler may move K before it evaluates the other argument.
      const auto Y = steps_[step].Y.rightCols(K.cols());
      K = minus_square(std::move(K), Y);
   }
   return K;
}

void FarFirst::condense(int eighths, VectorXd &loads) const
{
   for (int step = 0; step < 8 - eighths; ++step)
   {
      const Step &of = steps_[step];
      auto gone = loads.segment(begin_[step], of.Y.rows());
      of.factor.solve_half(gone);
      loads.tail(of.Y.cols()).noalias() -= of.Y.transpose() * gone;
   }
}

void FarFirst::locate(int eighths, VectorXd &u) const
{
   for (int step = 7 - eighths; step >= 0; --step)
   {
      const Step &of = steps_[step];
      auto gone = u.segment(begin_[step], of.Y.rows());
      gone.noalias() -= of.Y * u.tail(of.Y.cols());
      of.factor.solve_other_half(gone);
   }
}

NearContact::NearContact(const ReducedProblem &whole, const SymmetricProduct &times_K,
                         const FarFirst &far, int eighths)
   : whole_(whole), times_K_(times_K), far_(far), eighths_(eighths),
     problem_(std::make_shared<ReducedProblem>())
{
   const Index n = whole.nodes(), count = far.nodes(eighths), far_rows = far.before(eighths);
   std::vector<Index> place(whole.K.rows(), -1);
   for (Index k = far_rows; k < whole.K.rows(); ++k) { place[far.rows()[k]] = k - far_rows; }
   for (Index i = 0; i < n; ++i)
   {
      if (far.rank()[i] < count) { nodes_.push_back(i); }
   }
   for (Index component = 0; component <= whole.components(); ++component)
   {
      for (const Index i : nodes_)
      {
         rows_.push_back(component * n + i);
         if (component < whole.components()) { slips_.push_back(rows_.back()); }
         place_.push_back(place[rows_.back()]);
      }
   }
   ReducedProblem &part = *problem_;
   part.K = far.stiffness(eighths)(place_, place_);
   part.gap = whole.gap(nodes_);
   part.friction = whole.friction(nodes_);
   for (const Index i : nodes_)
   {
      if (!whole.laws.empty()) { part.laws.push_back(whole.laws[i]); }
   }
   if (whole.weights.size() > 0) { part.weights = whole.weights(nodes_); }
   for (const Index row : whole.held)
   {
      const auto found = std::find(rows_.begin(), rows_.end(), row);
      if (found != rows_.end()) { part.held.push_back(found - rows_.begin()); }
   }
   const ThinQR motions = thin_qr(whole.rigid_motions(rows_, Eigen::all));
   constexpr double hardly = 1e-4; // the largest entry of the motion may be at another node
   require(motions.R.cols() == 0 || motions.R.diagonal().cwiseAbs().minCoeff() > hardly,
           "near contact: a rigid motion hardly moves its nodes");
   part.rigid_motions = motions.Q;
   remove_motions(part.K, part.rigid_motions);
   if (!whole.coupled) { part.B().setZero(); }
   join_coupling(part);
   for (const LoadPattern &pattern : whole.patterns)
   {
      VectorXd forces(whole.K.rows());
      forces << pattern.q, pattern.p;
      VectorXd acting = forces(far.rows());
      far.condense(eighths, acting);
      condensed_.push_back(acting);
      const VectorXd left = acting.tail(place_.size())(place_);
      part.patterns.push_back(
         {pattern.name, pattern.control, left.head(part.slips()), left.tail(part.nodes())});
   }
   // The pattern of round-off. Its name is one that no other pattern has.
   std::string name = "round-off";
   for (const LoadPattern &pattern : whole.patterns) { name += pattern.name; }
   part.patterns.push_back(
      {name, Control::force, VectorXd::Zero(part.slips()), VectorXd::Zero(part.nodes())});
   part.validate();
}

VectorXd NearContact::loads(const VectorXd &multipliers) const
{
   VectorXd all(multipliers.size() + 1);
   all << multipliers, 1.0;
   return all;
}

bool NearContact::correct(const ContactState &whole)
{
   ReducedProblem &near = *problem_;
   ++parts_;
   const VectorXd u = whole.displacements(), f = whole_.clamped_forces(whole.multipliers),
                  stiff = times_K_(u), forces = stiff + f;
   // The start need not be an equilibrium: it may have an initial slip, for instance.
   double elsewhere = 0;
   for (Index k = 0; k < far_.before(eighths_); ++k)
   {
      elsewhere = std::max(elsewhere, std::abs(forces[far_.rows()[k]]));
   }
   const double scale = std::max({whole.peak_force, largest_entry(f), largest_entry(stiff)});
   if (elsewhere > 1e-6 * scale) { return false; }
   LoadPattern &round_off = near.patterns.back();
   round_off.q.setZero();
   round_off.p.setZero();
   VectorXd off =
      forces(rows_) - near.K * u(rows_) - near.clamped_forces(loads(whole.multipliers));
   off -= near.rigid_motions * (near.rigid_motions.transpose() * off);
   for (const Index row : near.held) { off[row] = 0; }
   round_off.q = off.head(near.slips());
   round_off.p = off.tail(near.nodes());
   return true;
}

std::optional<ContactState> NearContact::part(const ContactState &whole)
{
   if (!correct(whole)) { return std::nullopt; }
   ContactState part;
   part.v = whole.v(slips_);
   part.w = whole.w(nodes_);
   part.q = whole.q(slips_);
   part.p = whole.p(nodes_);
   part.slip_origin = whole.slip_origin(slips_);
   for (const Index i : nodes_) { part.status.push_back(whole.status[i]); }
   part.multipliers = loads(whole.multipliers);
   part.time = whole.time;
   part.peak_force = whole.peak_force;
   return part;
}

ContactState NearContact::whole(const ContactState &before, const ContactState &part) const
{
   ContactState next = before;
   next.time = part.time;
   next.multipliers = part.multipliers.head(before.multipliers.size());
   const VectorXd f = whole_.clamped_forces(next.multipliers);
   VectorXd u = VectorXd::Zero(f.size());
   for (std::size_t k = 0; k < condensed_.size(); ++k)
   {
      u -= next.multipliers[static_cast<Index>(k)] * condensed_[k];
   }
   u.tail(place_.size())(place_) = part.displacements();
   far_.locate(eighths_, u);
   VectorXd placed(u.size());
   placed(far_.rows()) = u;
   next.v = placed.head(whole_.slips());
   next.w = placed.tail(whole_.nodes());
   // Exact to the last bit, because round-off must not appear as slip.
   next.v(slips_) = part.v;
   next.w(nodes_) = part.w;
   next.q.setZero();
   next.p.setZero();
   next.q(slips_) = part.q;
   next.p(nodes_) = part.p;
   std::fill(next.status.begin(), next.status.end(), NodeState::separation);
   for (std::size_t k = 0; k < nodes_.size(); ++k) { next.status[nodes_[k]] = part.status[k]; }
   next.peak_force = std::max({before.peak_force, largest_entry(f),
                               largest_entry(whole_.clamped_forces(before.multipliers)),
                               largest_entry(next.forces())});
   return next;
}

FrictionSolver &NearContact::solver(const FrictionSettings &settings)
{
   if (!solver_) { solver_.emplace(problem_, settings); }
   return *solver_;
}

NearContacts::NearContacts(FrictionSolver &solver)
   : solver_(solver), problem_(solver.problem()),
     worthwhile_(problem_.nodes() >= many_nodes && problem_.components() > 0 &&
                 !solver.frictionless() &&
                 solver.settings().method != FrictionMethod::gauss_seidel)
{
}

int NearContacts::eighths(const ContactState &state)
{
   // Free bodies may come to rest anywhere.
   if (!worthwhile_ || free_motions(problem_, state.status).cols() > 0) { return 0; }
   if (!far_) { far_ = std::make_unique<FarFirst>(problem_); }
   Index farthest = -1;
   for (std::size_t i = 0; i < state.status.size(); ++i)
   {
      if (closed(state.status[i])) { farthest = std::max(farthest, far_->rank()[i]); }
   }
   const int least = far_->eighths((3 * (farthest + 1)) / 2 + 16);
   return least <= most_eighths ? least : 0;
}

int NearContacts::touched(const ContactState &state, int eighths) const
{
   Index farthest = -1;
   for (Index i = 0; i < problem_.nodes(); ++i)
   {
      if (far_->rank()[i] >= far_->nodes(eighths) && state.w[i] + problem_.gap[i] < 0)
      {
         farthest = std::max(farthest, far_->rank()[i]);
      }
   }
   return farthest < 0 ? 0 : far_->eighths(farthest + 1);
}

std::shared_ptr<NearContact> NearContacts::near(int eighths)
{
   const auto is = [&](const auto &kept) { return kept.first == eighths; };
   const auto found = std::find_if(kept_.begin(), kept_.end(), is);
   if (found != kept_.end()) { return found->second; }
   if (fails_[eighths]) { return nullptr; }
   std::shared_ptr<NearContact> made;
   if (!times_K_) { times_K_ = std::make_unique<SymmetricProduct>(problem_.K); }
   try
   {
      if (far_->leave(eighths))
      {
         made = std::make_shared<NearContact>(problem_, *times_K_, *far_, eighths);
      }
   }
   catch (const InputError &)
   {
      // So few nodes do not determine all motions.
   }
   fails_[eighths] = !made;
   if (!made) { return nullptr; }
   ++counters_.near_contacts;
   if (kept_.size() == 2)
   {
      counters_ += kept_.front().second->counters();
      kept_.erase(kept_.begin());
   }
   kept_.emplace_back(eighths, made);
   return made;
}

std::optional<NearContacts::Way> NearContacts::set_out(const ContactState &state, int eighths)
{
   if (eighths > most_eighths) { return std::nullopt; }
   std::shared_ptr<NearContact> of = near(eighths);
   if (!of) { return std::nullopt; }
   std::optional<ContactState> part = of->part(state);
   if (!part) { return std::nullopt; }
   return Way{std::move(of), std::move(*part)};
}

IncrementReport NearContacts::solve(ContactState &state, const VectorXd &multipliers)
{
   for (int more = eighths(state); more > 0;)
   {
      auto way = set_out(state, more);
      if (!way) { break; }
      const ContactState start = way->part;
      for (const bool last : {false, true})
      {
         const IncrementReport found = way->near->solver(solver_.settings())
                                          .solve(way->part, way->near->loads(multipliers));
         if (!solves(found)) { return solver_.solve(state, multipliers); }
         ContactState next = way->near->whole(state, way->part);
         if (const int needed = touched(next, more); needed > 0)
         {
            more = needed;
            break;
         }
         IncrementReport judged = solver_.judge(state, next);
         if (solves(judged))
         {
            judged.found_by = found.found_by;
            state = std::move(next);
            return judged;
         }
         // Solve the part again, with the forces corrected by the residual of all nodes.
         way->part = start;
         if (last || !way->near->correct(next)) { return solver_.solve(state, multipliers); }
      }
   }
   return solver_.solve(state, multipliers);
}

Counters NearContacts::counters() const
{
   Counters sum = counters_;
   for (const auto &[eighths, near] : kept_) { sum += near->counters(); }
   return sum;
}

} // namespace cattaneo
