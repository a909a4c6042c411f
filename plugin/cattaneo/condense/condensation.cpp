#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/condense/condensation.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/condense/middles.hpp>
#include <cattaneo/condense/supported_nodes.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <numeric>

namespace cattaneo
{

namespace
{

using Eigen::Index;

/// Puts rows at their positions in a larger matrix, with zeros elsewhere.
void spread(Eigen::MatrixXd &M, const std::vector<int> &positions, Eigen::Index rows)
{
   const Eigen::MatrixXd dense = std::move(M);
   M = Eigen::MatrixXd::Zero(rows, dense.cols());
   M(positions, Eigen::all) = dense;
}

/// Turns the frames of the line's nodes onto their supports. Returns the rows, in these frames,
/// that the supports hold.
std::vector<int> align(ContactLine &line, const ContactDofs &contact)
{
   const std::vector<int> &held = contact.held;
   if (line.formulation == Formulation::torsion) { return held; }
   const auto n = static_cast<int>(line.size());
   HeldComponents components = HeldComponents::Constant(n, 2, false), moved = components;
   for (int position : held)
   {
      components(position % n, position / n) = true;
      moved(position % n, position / n) =
         std::count(contact.in_moved_plane.begin(), contact.in_moved_plane.end(), position) > 0;
   }
   meet_supports(line, components, moved);
   std::vector<int> rows;
   for (int position : held)
   {
      const int i = position % n, c = position / n;
      const bool both = components(i, 0) && components(i, 1);
      rows.push_back(both ? position : nearest_axis(line.nodes[i].tangent) == c ? i : n + i);
   }
   std::sort(rows.begin(), rows.end());
   return rows;
}

/// Turns the frames of nodes onto their supports. Returns the rows, in these frames, that the
/// supports hold.
std::vector<int> align(ContactSurface &surface, const std::vector<int> &held)
{
   const auto n = static_cast<int>(surface.size());
   std::vector<std::array<bool, 3>> components(n, {false, false, false});
   for (int position : held) { components[position % n][position / n] = true; }
   std::vector<int> rows;
   for (int i = 0; i < n; ++i)
   {
      SurfaceNode &node = surface.nodes[i];
      node.frame =
         on_supports(node.frame, components[i], place_text(node.position, Formulation::space));
      for (int k = 0; k < 3; ++k)
      {
         if (lies_in(node.frame.row(k), components[i])) { rows.push_back(k * n + i); }
      }
   }
   std::sort(rows.begin(), rows.end());
   return rows;
}

} // namespace

Eigen::MatrixXd load_by_load(const std::vector<BodyLoad> &loads, const ClampedLoads &clamped)
{
   const auto count = static_cast<Eigen::Index>(loads.size());
   const Eigen::MatrixXd &response = clamped.response, &reaction = clamped.reaction;
   Eigen::MatrixXd H(count, count);
   for (Eigen::Index k = 0; k < count; ++k)
   {
      for (Eigen::Index j = 0; j < count; ++j)
      {
         const bool force = loads[k].control == Control::force;
         double &h = H(k, j);
         if (loads[j].control == loads[k].control)
         {
            // Flexibility of forces, or stiffness of prescribed displacements.
            h = 0.5 * (response(k, j) + response(j, k));
            if (!force) { h = 0.5 * (reaction(j, k) + reaction(k, j)) - h; }
         }
         else
         {
            // Displacement of force f in motion d; the reaction of the support to f has the
            // opposite sign.
            const Eigen::Index f = force ? k : j, d = force ? j : k;
            h = reaction(f, d) + response(f, d);
            if (!force) { h = -h; }
         }
      }
   }
   return H;
}

/* The forces f change by -S g. In H, the displacement of a load of forces changes because the
    other loads move the contact by -g. The reaction of a load of displacements changes by the
    work of all forces on its own -g, and by the work of its own forces on the -g of the other
    loads. */
void shift_contact(const Eigen::MatrixXd &g, const Eigen::MatrixXd &S,
                   const std::vector<Control> &controls, Eigen::MatrixXd &f, Eigen::MatrixXd &H)
{
   const Eigen::MatrixXd Sg = S * g, work = transposed_product(g, f);
   for (std::size_t j = 0; j < controls.size(); ++j)
   {
      const auto k = static_cast<Index>(j);
      const bool force = controls[j] == Control::force;
      H.row(k) += (force ? 1.0 : -1.0) * work.col(k).transpose();
      if (!force) { H.row(k) -= work.row(k); }
   }
   H += transposed_product(g, Sg);
   f -= Sg;
}

std::vector<int> others(const std::vector<int> &held, Eigen::Index count)
{
   std::vector<int> all(count), rest;
   std::iota(all.begin(), all.end(), 0);
   std::set_difference(all.begin(), all.end(), held.begin(), held.end(),
                       std::back_inserter(rest));
   return rest;
}

std::vector<int> ContactDofs::free_positions() const
{
   return others(held, static_cast<Eigen::Index>(all.size()));
}

std::vector<int> ContactDofs::free() const
{
   std::vector<int> dofs;
   for (int position : free_positions()) { dofs.push_back(all[position]); }
   require(!dofs.empty(), "condense: all components of all ", all.size(),
           " contact dofs are fixed, at least one must be free: is the boundary part that is "
           "named as contact the one that touches?");
   return dofs;
}

ContactDofs contact_dofs(const Trace &trace, Formulation formulation, int dofs)
{
   require(trace.formulation == formulation, "condense: the contact ", trace.kind(), " is ",
           name(trace.formulation), ", the body ", name(formulation),
           ", must be the same (is it a ", trace.kind(), " of this body?)");
   const Eigen::Index n = trace.size();
   std::vector<int> contact(trace.dofs.cols() * n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      for (Eigen::Index c = 0; c < trace.dofs.cols(); ++c)
      {
         const int dof = trace.dofs(i, c);
         require(dof >= 0 && dof < dofs, "condense: contact dof ", dof, " of node ", i,
                 " of the ", trace.kind(), ", must be from 0 to ", dofs - 1, " (is it a ",
                 trace.kind(), " of this body?)");
         contact[c * n + i] = dof;
      }
   }
   return {contact, {}};
}

ContactDofs contact_dofs(const ContactLine &line, Formulation formulation, int dofs)
{
   line.validate();
   return contact_dofs(Trace(line), formulation, dofs);
}

void ContactDofs::move(int position, Eigen::Index load, double by, const Trace &trace,
                       const std::vector<BodyLoad> &loads)
{
   const std::string pattern = "by load pattern '" + loads[load].name + "'";
   if (trace.formulation == Formulation::torsion)
   {
      refuse_motion(trace, position,
                    "is turned " + pattern +
                       ", contact nodes of torsion must be free or held by a support: end the "
                       "contact before the part that is turned");
   }
   if (moved.size() == 0)
   {
      moved = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(all.size()),
                                    static_cast<Eigen::Index>(loads.size()));
   }
   moved(position, load) = by;
}

bool moves_plane(const Trace &trace, int position, const DofPlaces &places,
                 const std::vector<int> &fixed, const std::vector<BodyLoad> &loads)
{
   const auto n = static_cast<int>(trace.size());
   const int c = position / n, i = position % n;
   return std::any_of(fixed.begin(), fixed.end(),
                      [&](int dof)
                      {
                         return places.component[dof] == c &&
                                std::abs(places.place(dof)[c] - trace.position(i, c)) <=
                                   1e-6 * trace.spacing[i] &&
                                std::any_of(loads.begin(), loads.end(),
                                            [&](const BodyLoad &load) {
                                               return load.control == Control::displacement &&
                                                      load.values[dof] != 0;
                                            });
                      });
}

void refuse_motion(const Trace &trace, int position, const std::string &how)
{
   const auto n = static_cast<int>(trace.size());
   throw InputError(std::string("condense: component ") +
                    component_name(trace.formulation, position / n) +
                    " of the contact node at " + trace.called(position % n) + " " + how);
}

namespace
{

/// InputError if a support holds a component of the middle of an edge whose ends it leaves
/// free: such a support would be a relation between unknowns (ContactSurface).
void require_ends_held(const ContactSurface &surface, const std::vector<int> &held)
{
   const auto n = static_cast<int>(surface.size());
   for (int position : held)
   {
      const SurfaceNode &node = surface.nodes[position % n];
      for (Index end : node.between)
      {
         const auto its = static_cast<int>(end) + position / n * n;
         require(
            end < 0 || std::binary_search(held.begin(), held.end(), its),
            "condense: a support holds component ",
            component_name(Formulation::space, position / n), " of the contact node at ",
            place_text(node.position, Formulation::space),
            ", the middle of an edge, and not of the end of the edge at ",
            place_text(surface.nodes[std::max<Index>(end, 0)].position, Formulation::space),
            ": it must hold both ends as well");
      }
   }
}

/// The results of a condensation in the frames of the body's trace, which are turned to its
/// supports.
CondensedBody in_frames(CondensedBody result, const std::vector<BodyLoad> &loads,
                        const ContactDofs &contact, Condensation found)
{
   if (!contact.held.empty())
   {
      const std::vector<int> free = contact.free_positions();
      const auto rows = static_cast<Eigen::Index>(contact.all.size());
      spread(found.S, free, rows);
      found.S.transposeInPlace();
      spread(found.S, free, rows);
      spread(found.free.contact, free, rows);
      spread(found.clamped.forces, free, rows);
   }
   result.H = found.H.size() > 0 || loads.empty() ? std::move(found.H)
                                                  : load_by_load(loads, found.clamped);
   // Converts from the nodes to the unknowns of the trace.
   if (const Middles middles(result.surface); !middles.none())
   {
      if (result.moved.size() > 0)
      {
         // If the unknowns are at rest, the middle of an edge still moves with ends that a load
         // moves.
         std::vector<Control> controls;
         for (const BodyLoad &load : loads) { controls.push_back(load.control); }
         middles.to_unknowns(result.moved);
         const std::vector<int> free = contact.free_positions();
         result.moved(free, Eigen::all).setZero();
         Eigen::MatrixXd along = result.moved;
         middles.to_nodes(along);
         along(contact.held, Eigen::all).setZero();
         shift_contact(-along, found.S, controls, found.clamped.forces, result.H);
      }
      middles.stiffness_to_unknowns(found.S);
      middles.forces_to_unknowns(found.clamped.forces);
      middles.to_unknowns(found.free.contact);
   }
   result.counters = found.counters;
   result.solver = std::move(found.solver);
   result.rigid_modes = found.free.count;
   const Equilibrium equilibrium(found.free);
   equilibrium.impose_on_stiffness(found.S);
   equilibrium.impose_on_forces(found.clamped.forces);
   const FrameChange frames = frames_of(result);
   result.S = frames.both(std::move(found.S));
   // Displacements change with the frames as forces do, except in torsion, where they are r
   // times the twist.
   const Eigen::MatrixXd &motions = equilibrium.motions();
   const bool twists = result.line.formulation == Formulation::torsion;
   result.free_motions = twists ? thin_qr(frames.inverse().rows(motions)).Q
                                : frames.inverse().transposed().rows(motions);
   if (!twists && motions.cols() > 0 && !frames.rotates())
   {
      result.free_motions = thin_qr(result.free_motions).Q;
   }
   Eigen::MatrixXd local = frames.rows(found.clamped.forces);
   for (int row : result.held) // not even round-off of the free motions
   {
      result.S.row(row).setZero();
      result.S.col(row).setZero();
      result.free_motions.row(row).setZero();
      local.row(row).setZero();
   }
   // In torsion all are tangential.
   const Eigen::Index normals = twists ? 0 : result.nodes();
   for (std::size_t k = 0; k < loads.size(); ++k)
   {
      const auto force = local.col(static_cast<Eigen::Index>(k));
      result.patterns.push_back({loads[k].name, loads[k].control,
                                 force.head(local.rows() - normals), force.tail(normals)});
   }
   return result;
}

} // namespace

CondensedBody in_local_frames(const ContactLine &line, const std::vector<BodyLoad> &loads,
                              const ContactDofs &contact, Condensation found)
{
   CondensedBody result;
   result.line = line;
   if (!contact.held.empty())
   {
      result.held = align(result.line, contact);
      result.moved = contact.moved;
   }
   return in_frames(std::move(result), loads, contact, std::move(found));
}

CondensedBody in_local_frames(const ContactSurface &surface, const std::vector<BodyLoad> &loads,
                              const ContactDofs &contact, Condensation found)
{
   CondensedBody result;
   result.line.formulation = Formulation::space;
   result.surface = surface;
   require_ends_held(surface, contact.held);
   if (!contact.held.empty())
   {
      result.held = align(result.surface, contact.held);
      result.moved = contact.moved;
   }
   return in_frames(std::move(result), loads, contact, std::move(found));
}

} // namespace cattaneo
