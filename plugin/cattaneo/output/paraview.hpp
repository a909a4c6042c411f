#pragma once

#include <cattaneo/elastic/body.hpp>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/output/paraview_half_plane.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cattaneo
{

/** Series of a body's fields for ParaView (5.5 or newer), in the folder `directory`/`name`:
    open `name`.pvd. Fields: "displacement"; "sigma_xx", "sigma_yy", "sigma_zz", "tau_xy"
    (tension positive) and "von_mises" on discontinuous elements of the body's own order, from
    each element's own material; in space also "tau_yz" and "tau_xz". Axisymmetric: "sigma_rr",
    "sigma_zz", "sigma_tt" (hoop) and "tau_rz"; a torsion body has "twist", "tau_rt" and
   "tau_tz" instead. A body with a user's operator has stresses only after
   ElasticBody::set_stress(), otherwise only the displacement.

    The body must outlive this. Nothing is computed or written before write(). */
class BodyFields
{
public:
   /// The folder is made by the first write().
   BodyFields(const ElasticBody &body, const std::string &directory, const std::string &name);

   /// Writes one more time of the series. `displacement`: all true dofs, as
   /// Reduction::displacement gives them; `loads`: as for stress_at(); loads of other bodies
   /// may be among them, and names that are not needed are ignored. InputError if the size is
   /// wrong, an initial strain has no multiplier or the folder cannot be written.
   void write(const mfem::Vector &displacement, double time, const NamedLoads &loads = {});
   /// The same for a vector of Eigen's.
   void write(const Eigen::VectorXd &displacement, double time, const NamedLoads &loads = {});

   /// A field as last written; InputError with the list of names if there is none of that name.
   const mfem::GridFunction &field(const std::string &name) const;

private:
   void evaluate_stress(const NamedLoads &loads);

   const ElasticBody &body_;
   std::string directory_;
   std::unique_ptr<mfem::L2_FECollection> collection_;
   std::unique_ptr<mfem::FiniteElementSpace> stress_space_;
   std::map<std::string, std::unique_ptr<mfem::GridFunction>> fields_;
   mfem::ParaViewDataCollection series_;
};

/** Series of a contact line for ParaView, in the folder `directory`/`name`: open `name`.pvd.
    One polyline a chain of nodes, at the reference position of body 1, with the point data
    arc_length, gap (initial), state (0 stick, 1 separation, 2 forward slip, 3 backward slip, 4
    slip in no direction; see settled_states()), p and q (tractions: nodal forces over
    consistent weights), slip (v) and opening (w + g), and, if there are several interfaces, the
    number of each node's interface, from 0. Plane problems.

    The problem must outlive this. */
class ContactLineFields
{
public:
   /// The folder is made by the first write(). InputError unless the problem is of the plane.
   ContactLineFields(const ReducedProblem &problem, const std::string &directory,
                     const std::string &name);

   /// Writes one more time of the series, that of the state. InputError if the state does not
   /// fit or the folder cannot be written.
   void write(const ContactState &state);

private:
   const ReducedProblem &problem_;
   std::string directory_, name_;
   std::vector<double> times_;
};

/** The same of the contact surfaces of bodies in space: one polygon a face, and the point data
    gap, state, p, q and slip (vectors along x, y and z, those of the body that has the nodes),
    opening, and of several interfaces the number of each node's. Values are those of the
    unknowns, see ContactSurface.

    The reduction must outlive this. */
class ContactSurfaceFields
{
public:
   /// The folder is made by the first write(). InputError unless the reduction is in space.
   ContactSurfaceFields(const Reduction &reduction, const std::string &directory,
                        const std::string &name);

   /// Writes one more time of the series, that of the state. InputError if the state does not
   /// fit or the folder cannot be written.
   void write(const ContactState &state);

private:
   const Reduction &reduction_;
   std::string directory_, name_;
   std::vector<std::vector<Eigen::Index>> faces_; ///< nodes of the problem around each
   std::vector<double> times_;
};

/** All series of a reduction in a folder, contact.pvd and one of each body by its name
    (body1.pvd and so on of those without), a time after the other: made to be called from a
    MarchObserver, since it holds no state. Plane problems, axisymmetric ones without torsion,
    and bodies in space.

    All must outlive this. */
class ReductionFields
{
public:
   /// `bodies`: those that the reduction was made of, in its order; InputError if their number
   /// is another. `half_plane`: on which the last of them stands, which has no mesh of its own.
   ReductionFields(Reduction &reduction, const std::vector<const ElasticBody *> &bodies,
                   const std::string &directory, const HalfPlane *half_plane = nullptr);

   /// Recovers the fields of the bodies, one solve each, and writes them. On several ranks all
   /// must call it. The first rank writes the data that they share. InputError as BodyFields
   /// and ContactLineFields.
   void write(const ContactState &state);

   /// The fields of the half-plane; null if there is none.
   const HalfPlaneFields *below() const { return below_.get(); }

private:
   Reduction &reduction_;
   std::optional<ContactLineFields> contact_;    ///< none where all is tied, nor in space
   std::optional<ContactSurfaceFields> surface_; ///< in space
   std::vector<const ElasticBody *> bodies_;
   std::vector<std::unique_ptr<BodyFields>> fields_;
   std::unique_ptr<HalfPlaneFields> below_;
};

} // namespace cattaneo
