#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduction.hpp>

namespace cattaneo
{

Eigen::VectorXd Reduction::recover(CondensedBody &body, const Eigen::VectorXd &u,
                                   const std::vector<int> &patterns,
                                   const Eigen::VectorXd &multipliers)
{
   Eigen::VectorXd own(patterns.size());
   for (std::size_t k = 0; k < patterns.size(); ++k) { own[k] = multipliers[patterns[k]]; }
   Counters added = body.counters;
   Eigen::VectorXd field = body.recover(u, own);
   added -= body.counters;
   counters -= added;
   return field;
}

Eigen::VectorXd Reduction::without_torsion(const Eigen::VectorXd &u) const
{
   const Eigen::Index n = problem.nodes();
   if (torsion.empty()) { return u; }
   Eigen::VectorXd rest(2 * n);
   rest << u.head(n), u.tail(n);
   return rest;
}

Eigen::VectorXd Reduction::displacement(int b, const Eigen::VectorXd &v,
                                        const Eigen::VectorXd &w,
                                        const Eigen::VectorXd &multipliers)
{
   const Eigen::Index n = problem.nodes();
   require(b >= 0 && b < static_cast<int>(bodies.size()), "displacement: body ", b,
           ", must be from 0 to ", bodies.size() - 1);
   const Eigen::Index tangential = problem.slips();
   require(v.size() == tangential && w.size() == n, "displacement: ", v.size(),
           " tangential and ", w.size(), " normal displacements, must be ", tangential, " and ",
           n);
   require(multipliers.size() == static_cast<Eigen::Index>(problem.patterns.size()),
           "displacement: ", multipliers.size(), " load multipliers, must be ",
           problem.patterns.size());
   Eigen::VectorXd relative(tangential + n);
   relative << v, w;
   const Eigen::VectorXd all = moved(relative, multipliers), u = without_torsion(all);
   const Eigen::VectorXd loads = acting(all, multipliers);
   return recover(bodies[b], union_->own(bodies, b, u, loads), pattern_[b], loads);
}

Eigen::VectorXd Reduction::tied_forces(const Eigen::VectorXd &v, const Eigen::VectorXd &w,
                                       const Eigen::VectorXd &multipliers) const
{
   if (!union_) { return {}; }
   const Eigen::Index n = problem.nodes();
   Eigen::VectorXd relative(v.size() + n);
   relative << v, w;
   const Eigen::VectorXd all = moved(relative, multipliers);
   return union_->tied(without_torsion(all), acting(all, multipliers));
}

Eigen::VectorXd Reduction::tied_twisting(const Eigen::VectorXd &v,
                                         const Eigen::VectorXd &multipliers) const
{
   if (!torsion_union_) { return {}; }
   const Eigen::Index n = problem.nodes();
   Eigen::VectorXd u = v.tail(n);
   if (obstacle_.size() > 0) { u += (obstacle_ * multipliers).segment(n, n); }
   return torsion_union_->tied(u, multipliers);
}

Eigen::VectorXd Reduction::twist(int b, const Eigen::VectorXd &v,
                                 const Eigen::VectorXd &multipliers)
{
   const Eigen::Index n = problem.nodes();
   require(b >= 0 && b < static_cast<int>(torsion.size()), "twist: body ", b,
           ", must be below ", torsion.size(), ", the number of bodies that twist");
   require(v.size() == 2 * n, "twist: ", v.size(), " tangential displacements, must be ",
           2 * n);
   require(multipliers.size() == static_cast<Eigen::Index>(problem.patterns.size()),
           "twist: ", multipliers.size(), " load multipliers, must be ",
           problem.patterns.size());
   require(shanks_.empty(),
           "twist: the reduction has bolts with shanks, which do not twist, must have none");
   Eigen::VectorXd u = v.tail(n);
   if (obstacle_.size() > 0) { u += (obstacle_ * multipliers).segment(n, n); }
   return recover(torsion[b], torsion_union_->own(torsion, b, u, multipliers),
                  torsion_pattern_[b], multipliers);
}

} // namespace cattaneo
