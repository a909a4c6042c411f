#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/bodies_union.hpp>
#include <cattaneo/reduced/curve_gaps.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cmath>
#include <numeric>

namespace cattaneo
{

namespace
{

InterfaceReport fill(ReducedProblem &problem, Block block, const ContactLine &line)
{
   const Eigen::Index n = line.size();
   InterfaceReport report;
   report.name = "contact";
   report.nodes = n;
   report.position = line.each(&LineNode::position);
   report.outline = line.outline();
   report.tangent = line.each(&LineNode::tangent);
   report.acts_at = {report.position, report.position};
   report.weights = line.each(&LineNode::weight);
   report.spacing = line.each(&LineNode::spacing);
   report.turn = Eigen::VectorXd::Zero(n);
   problem.weights = line.each(&LineNode::weight);
   problem.arc_length = line.each(&LineNode::arc_length);
   problem.position = line.each(&LineNode::position);
   for (int row : block.held)
   {
      require(row < n, "reduce: the contact node at ", line.nodes[row % n].position,
              " is fixed normal to the line, it must be able to open: the contact line must "
              "end before it");
   }
   take(std::move(block), problem);
   // A rigid obstacle is known where the line is, and taken to go on.
   for (const LineChain &chain : line.chains)
   {
      problem.chains.push_back({"contact",
                                chain.first,
                                chain.nodes,
                                chain.loop,
                                chain.ends,
                                {LineEnd::smooth, LineEnd::smooth}});
   }
   return report;
}

/// How the boundary goes on at a node of a line: within the line it does so smoothly.
LineEnd goes_on_at(const ContactLine &line, Eigen::Index node)
{
   const LineChain &chain = line.chain_of(node);
   if (chain.loop) { return LineEnd::smooth; }
   // The lines of two bodies run against each other: body 1's first node is body 2's last. A
   // chain of one node has two ends there: the one that does not go on decides.
   const bool first = node == chain.first, last = node == chain.first + chain.nodes - 1;
   if (first && last)
   {
      return chain.ends[0] == LineEnd::smooth ? chain.ends[1] : chain.ends[0];
   }
   return first ? chain.ends[0] : last ? chain.ends[1] : LineEnd::smooth;
}

/// Gives the contact nodes of a body other tangents, and all that it knows in their frames.
void turn(CondensedBody &body, const std::vector<LineNode> &nodes)
{
   const Eigen::Index n = body.line.size();
   FrameChange frames{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n),
                      Eigen::VectorXd(n)};
   for (Eigen::Index i = 0; i < n; ++i)
   {
      LineNode &own = body.line.nodes[i];
      frames.a[i] = frames.d[i] = nodes[i].tangent.dot(own.tangent);
      frames.b[i] = nodes[i].tangent.dot(own.normal());
      frames.c[i] = -frames.b[i];
      own.tangent = nodes[i].tangent;
   }
   if (frames.b.isZero(0)) { return; }
   body.S = frames.both(std::move(body.S));
   body.free_motions = frames.rows(body.free_motions);
   for (LoadPattern &pattern : body.patterns)
   {
      Eigen::VectorXd f(2 * n);
      f << pattern.q, pattern.p;
      f = frames.rows(f);
      pattern.q = f.head(n);
      pattern.p = f.tail(n);
   }
}

/// Does a support hold one component of a node of either body that is not along the frames of
/// both?
bool leans_on_support(const CondensedBody &first, const CondensedBody &second,
                      const std::vector<int> &partner)
{
   const auto held = [](const CondensedBody &body, int node)
   { return holds(body, node, 0) != holds(body, node, 1); };
   const auto leans = [](const LineNode &node)
   { return node.tangent.cwiseAbs().minCoeff() > 0; };
   for (int i = 0; i < static_cast<int>(partner.size()); ++i)
   {
      if ((held(first, i) || held(second, partner[i])) &&
          (leans(first.line.nodes[i]) || leans(second.line.nodes[partner[i]])))
      {
         return true;
      }
   }
   return false;
}

/// Numbers from 0.
std::vector<int> each_of(Eigen::Index count)
{
   std::vector<int> all(count);
   std::iota(all.begin(), all.end(), 0);
   return all;
}

/// Gives the first body the mean frames of paired nodes.
void lie_between(CondensedBody &first, const CondensedBody &second,
                 const std::vector<int> &partner)
{
   std::vector<LineNode> nodes = first.line.nodes;
   for (std::size_t i = 0; i < nodes.size(); ++i)
   {
      nodes[i] = mean_frame(nodes[i], second.line.nodes[partner[i]]);
   }
   turn(first, nodes);
}

} // namespace

Reduction reduce(CondensedBody body, const ScalarField &gap)
{
   Reduction result;
   require(body.line.formulation != Formulation::torsion,
           "reduce: the body is one of torsion, which is to be added to a reduction");
   result.counters = body.counters;
   result.bodies.push_back(std::move(body));
   const CondensedBody &only = result.bodies.front();
   ReducedProblem &problem = result.problem;
   result.pattern_ = join(result.bodies, problem.patterns);
   const auto count = static_cast<Eigen::Index>(problem.patterns.size());
   result.interfaces = {fill(problem, alone(only, result.pattern_[0], count), only.line)};
   const Eigen::Index n = only.line.size();
   InterfaceReport &report = result.interfaces[0];
   const CurveGaps curves = curve_gaps(only.line, each_of(n), report.tangent);
   report.chords = curves.left;
   report.curved = curves.curved;
   problem.gap.resize(n);
   problem.dofs.resize(n, 2);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const LineNode &node = only.line.nodes[i];
      problem.gap[i] = gap(report.outline(i, 0), report.outline(i, 1));
      require(std::isfinite(problem.gap[i]), "reduce: the gap at ", node.position, " is ",
              problem.gap[i], ", must be finite");
      problem.dofs.row(i) << node.dofs[0], node.dofs[1];
   }
   return result;
}

Reduction reduce(CondensedBody body1, CondensedBody body2, const Pairing &pairing)
{
   const Eigen::Index n = body1.line.size();
   require(
      body1.line.formulation == body2.line.formulation &&
         body1.line.formulation != Formulation::torsion,
      "reduce: the bodies must be both plane or both axisymmetric (those of torsion are added "
      "to a reduction of these)");
   require(body2.line.size() == n && static_cast<Eigen::Index>(pairing.partner.size()) == n &&
              pairing.gap.size() == n,
           "reduce: contact lines of ", n, " and ", body2.line.size(),
           " nodes with a pairing of ", pairing.partner.size(), ", must be as many");
   std::vector<bool> taken(n, false);
   for (int j : pairing.partner)
   {
      require(j >= 0 && j < n && !taken[j], "reduce: partner ", j,
              " in the pairing, must be each of 0 to ", n - 1, " once");
      taken[j] = true;
   }
   if (leans_on_support(body1, body2, pairing.partner))
   {
      Interface contact;
      contact.first = {0, body1.line};
      contact.second = {1, body2.line};
      contact.pairing = pairing;
      std::vector<CondensedBody> bodies;
      bodies.push_back(std::move(body1));
      bodies.push_back(std::move(body2));
      return reduce_by_rows(std::move(bodies), {contact});
   }
   Reduction result;
   result.counters = body1.counters;
   result.counters += body2.counters;
   ++result.counters.unions;
   Eigen::VectorXd angles(n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      angles[i] = angle_between(body1.line.nodes[i].tangent,
                                -body2.line.nodes[pairing.partner[i]].tangent);
   }
   const int differing = differing_element(body1.line, body2.line, pairing);
   lie_between(body1, body2, pairing.partner);
   result.bodies.push_back(std::move(body1));
   result.bodies.push_back(std::move(body2));
   const CondensedBody &first = result.bodies[0], &second = result.bodies[1];
   ReducedProblem &problem = result.problem;
   result.pattern_ = join(result.bodies, problem.patterns);
   Block block = united(first, second, pairing.partner, result.pattern_, problem.patterns);
   result.union_ = block.way_back;
   result.partner_ = pairing.partner;
   result.interfaces = {fill(problem, std::move(block), first.line)};
   result.interfaces[0].bodies = {0, 1};
   result.interfaces[0].matching = true;
   result.interfaces[0].turn = angles;
   if (differing >= 0)
   {
      result.interfaces[0].differing = first.line.nodes[differing].position;
   }
   result.interfaces[0].acts_at[1] =
      second.line.each(&LineNode::position)(pairing.partner, Eigen::all);
   for (ContactChain &chain : problem.chains)
   {
      chain.other_ends = {
         goes_on_at(second.line, pairing.partner[chain.first]),
         goes_on_at(second.line, pairing.partner[chain.first + chain.nodes - 1])};
      chain.bodies = {0, 1};
   }
   // Their mean, as frames are: of curved lines that part the two differ.
   const Eigen::VectorXd other_weights = second.line.each(&LineNode::weight)(pairing.partner);
   problem.weights = 0.5 * (problem.weights + other_weights);
   result.interfaces[0].weights = problem.weights;
   const CurveGaps curves = curve_gaps(first.line, each_of(n), result.interfaces[0].tangent,
                                       second.line, pairing.partner);
   result.interfaces[0].chords = curves.left;
   result.interfaces[0].curved = curves.curved;
   problem.gap = pairing.gap + curves.moved;
   problem.dofs.resize(n, 4);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const auto &dofs1 = first.line.nodes[i].dofs,
                 &dofs2 = second.line.nodes[pairing.partner[i]].dofs;
      problem.dofs.row(i) << dofs1[0], dofs1[1], dofs2[0], dofs2[1];
   }
   return result;
}

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
   if (union_) { u = union_->own(bodies, b, u, loads); }
   return recover(bodies[b], u, pattern_[b], loads);
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
   if (torsion_union_) { u = torsion_union_->own(torsion, b, u, multipliers); }
   return recover(torsion[b], u, torsion_pattern_[b], multipliers);
}

} // namespace cattaneo
