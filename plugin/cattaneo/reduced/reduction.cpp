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

Eigen::VectorXd Reduction::displacement(int b, const Eigen::VectorXd &v,
                                        const Eigen::VectorXd &w,
                                        const Eigen::VectorXd &multipliers)
{
   const Eigen::Index n = problem.nodes();
   require(b >= 0 && b < static_cast<int>(bodies.size()), "displacement: body ", b,
           ", must be from 0 to ", bodies.size() - 1);
   const Eigen::Index tangential = torsion.empty() ? n : 2 * n;
   require(v.size() == tangential && w.size() == n, "displacement: ", v.size(),
           " tangential and ", w.size(), " normal displacements, must be ", tangential, " and ",
           n);
   require(multipliers.size() == static_cast<Eigen::Index>(problem.patterns.size()),
           "displacement: ", multipliers.size(), " load multipliers, must be ",
           problem.patterns.size());
   Eigen::VectorXd relative(tangential + n), u(2 * n);
   relative << v, w;
   const Eigen::VectorXd all = moved(relative, multipliers);
   u << all.head(n), all.tail(n);
   const Eigen::VectorXd loads = acting(all, multipliers);
   return recover(bodies[b], union_->own(bodies, b, u, loads), pattern_[b], loads);
}

Eigen::VectorXd Reduction::tied_forces(const Eigen::VectorXd &v, const Eigen::VectorXd &w,
                                       const Eigen::VectorXd &multipliers) const
{
   if (!union_) { return {}; }
   const Eigen::Index n = problem.nodes();
   Eigen::VectorXd relative(v.size() + n), u(2 * n);
   relative << v, w;
   const Eigen::VectorXd all = moved(relative, multipliers);
   u << all.head(n), all.tail(n);
   return union_->tied(u, acting(all, multipliers));
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
           ", the reduction has ", torsion.size(), " that twist (counted from 0)");
   require(v.size() == 2 * n, "twist: ", v.size(), " tangential displacements, must be ",
           2 * n);
   require(multipliers.size() == static_cast<Eigen::Index>(problem.patterns.size()),
           "twist: ", multipliers.size(), " load multipliers, must be ",
           problem.patterns.size());
   require(shanks_.empty(), "twist: of a reduction with shanks, must be without");
   Eigen::VectorXd u = v.tail(n);
   if (obstacle_.size() > 0) { u += (obstacle_ * multipliers).segment(n, n); }
   return recover(torsion[b], torsion_union_->own(torsion, b, u, multipliers),
                  torsion_pattern_[b], multipliers);
}

} // namespace cattaneo
