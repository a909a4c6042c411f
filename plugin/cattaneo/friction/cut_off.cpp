#include <cattaneo/friction/cut_off.hpp>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;

std::string CutOffContact::message() const
{
   std::ostringstream text;
   if (chain < 0)
   {
      text << "contact is compressed up to the rim of its surface (node " << node << " at ("
           << x << ", " << y << "), time " << time
           << ") although the bodies go on beyond it: forces and areas are wrong there, name "
              "more of the surface as contact";
      return text.str();
   }
   text
      << "contact is compressed up to the " << (at_first ? "first" : "last")
      << " node of piece " << chain + 1 << " of the line '" << interface << "' (node " << node
      << " at (" << x << ", " << y << "), time " << time
      << ") although the boundaries of both bodies go on smoothly beyond it: forces and zones "
         "are wrong there, name more of the boundaries as contact";
   return text.str();
}

std::vector<CutOffContact> cut_off_contact(const ReducedProblem &problem,
                                           const ContactState &state)
{
   std::vector<CutOffContact> found;
   const double compressed = problem.nodes() ? 1e-9 * state.p.maxCoeff() : 0.0;
   const auto note = [&](CutOffContact here)
   {
      if (problem.position.rows() == problem.nodes())
      {
         here.x = problem.position(here.node, 0);
         here.y = problem.position(here.node, 1);
      }
      here.time = state.time;
      found.push_back(std::move(here));
   };
   for (std::size_t c = 0; c < problem.chains.size(); ++c)
   {
      const ContactChain &chain = problem.chains[c];
      for (const std::size_t end : {0, 1})
      {
         if (chain.loop || chain.ends[end] != LineEnd::smooth ||
             chain.other_ends[end] != LineEnd::smooth)
         {
            continue;
         }
         const Index node = end == 0 ? chain.first : chain.first + chain.nodes - 1;
         if (!closed(state.status[node]) || !(state.p[node] > compressed)) { continue; }
         CutOffContact here;
         here.interface = chain.interface;
         here.chain = static_cast<Index>(c);
         here.node = node;
         here.at_first = end == 0;
         note(here);
      }
   }
   // On a surface report the node of the rim with the largest force.
   CutOffContact rim;
   rim.chain = rim.node = -1;
   for (const Index node : problem.rim)
   {
      const bool bears = closed(state.status[node]) && state.p[node] > compressed;
      if (bears && (rim.node < 0 || state.p[node] > state.p[rim.node])) { rim.node = node; }
   }
   if (rim.node >= 0) { note(rim); }
   return found;
}

} // namespace cattaneo
