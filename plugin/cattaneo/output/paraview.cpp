#include <array>
#include <cattaneo/elastic/point_stress.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/friction/load_history.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/paraview.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/whole_file.hpp>
#include <sstream>

namespace cattaneo
{

namespace
{

std::vector<std::string> stress_names(Formulation formulation)
{
   if (formulation == Formulation::torsion) { return {"tau_rt", "tau_tz"}; }
   if (formulation == Formulation::plane)
   {
      return {"sigma_xx", "sigma_yy", "sigma_zz", "tau_xy", "von_mises"};
   }
   return {"sigma_rr", "sigma_zz", "sigma_tt", "tau_rz", "von_mises"};
}

const char *unknown(Formulation formulation)
{
   return formulation == Formulation::torsion ? "twist" : "displacement";
}

/// The contact forces on the last body, in the frames of its line.
Eigen::VectorXd forces_below(const Reduction &reduction, const ContactState &state)
{
   const ContactLine &below = reduction.bodies.back().line;
   const Eigen::MatrixX2d all =
      reduction.contact_forces(static_cast<int>(reduction.bodies.size()) - 1, state.q, state.p,
                               reduction.tied_forces(state.v, state.w, state.multipliers));
   Eigen::VectorXd forces(2 * below.size());
   for (Eigen::Index i = 0; i < below.size(); ++i)
   {
      forces[i] = all.row(i).dot(below.nodes[i].tangent);
      forces[below.size() + i] = all.row(i).dot(below.nodes[i].normal());
   }
   return forces;
}

} // namespace

BodyFields::BodyFields(const ElasticBody &body, const std::string &directory,
                       const std::string &name)
   : body_(body), directory_(directory), series_(name, body.space().GetMesh())
{
   mfem::FiniteElementSpace &space = body.space();
   const int order = space.GetMaxElementOrder();
   fields_[unknown(body.formulation())] = std::make_unique<mfem::GridFunction>(&space);
   if (body.has_stress())
   {
      collection_ =
         std::make_unique<mfem::L2_FECollection>(order, 2, mfem::BasisType::GaussLobatto);
      stress_space_ =
         std::make_unique<mfem::FiniteElementSpace>(space.GetMesh(), collection_.get());
      for (const std::string &component : stress_names(body.formulation()))
      {
         fields_[component] = std::make_unique<mfem::GridFunction>(stress_space_.get());
      }
   }
   series_.SetPrefixPath(directory);
   series_.SetHighOrderOutput(true);
   series_.SetLevelsOfDetail(order);
   for (const auto &[field_name, field] : fields_)
   {
      *field = 0.0;
      series_.RegisterField(field_name, field.get());
   }
}

void BodyFields::write(const Eigen::VectorXd &displacement, double time,
                       const NamedLoads &loads)
{
   write(to_mfem(displacement), time, loads);
}

void BodyFields::write(const mfem::Vector &displacement, double time, const NamedLoads &loads)
{
   require(displacement.Size() == body_.space().GetTrueVSize(),
           "ParaView output: ", displacement.Size(), " displacements, the body has ",
           body_.space().GetTrueVSize(), " true dofs");
   mfem::GridFunction &field = *fields_.at(unknown(body_.formulation()));
   if (const mfem::Operator *P = body_.space().GetProlongationMatrix())
   {
      P->Mult(displacement, field);
   }
   else { field = displacement; }
   if (stress_space_) { evaluate_stress(loads); }
   save(series_, directory_, time);
}

/// The nodes of the stress elements are points of the body's elements: the stress is
/// interpolated there, exactly where it is a polynomial of the elements' order.
void BodyFields::evaluate_stress(const NamedLoads &loads)
{
   const mfem::GridFunction &u = *fields_.at(unknown(body_.formulation()));
   mfem::Mesh &mesh = *stress_space_->GetMesh();
   std::vector<mfem::GridFunction *> component;
   for (const std::string &field_name : stress_names(body_.formulation()))
   {
      component.push_back(fields_.at(field_name).get());
   }
   mfem::IsoparametricTransformation transformation;
   mfem::Array<int> dofs;
   for (int e = 0; e < mesh.GetNE(); ++e)
   {
      mesh.GetElementTransformation(e, &transformation);
      stress_space_->GetElementDofs(e, dofs);
      const mfem::IntegrationRule &nodes = stress_space_->GetFE(e)->GetNodes();
      for (int i = 0; i < dofs.Size(); ++i)
      {
         transformation.SetIntPoint(&nodes.IntPoint(i));
         std::array<double, 5> values{};
         if (body_.formulation() == Formulation::torsion)
         {
            const TorsionStress s = torsion_stress_at(body_, u, transformation);
            values = {s.r_theta, s.theta_z};
         }
         else
         {
            const Stress s = stress_at(body_, u, transformation, loads);
            values = {s.xx, s.yy, s.zz, s.xy, s.von_mises()};
         }
         for (std::size_t c = 0; c < component.size(); ++c)
         {
            (*component[c])(dofs[i]) = values[c];
         }
      }
   }
}

const mfem::GridFunction &BodyFields::field(const std::string &name) const
{
   std::string known;
   for (const auto &[field_name, field] : fields_)
   {
      if (field_name == name) { return *field; }
      known += (known.empty() ? "" : ", ") + field_name;
   }
   throw InputError("ParaView output: there is no field '" + name + "'; there are: " + known);
}

ContactLineFields::ContactLineFields(const ReducedProblem &problem,
                                     const std::string &directory, const std::string &name)
   : problem_(problem), directory_(directory), name_(name)
{
   const Eigen::Index n = problem.nodes();
   require(problem.components() <= 1, "ParaView output: the problem has ", problem.components(),
           " tangential components, must have at most 1");
   require(problem.arc_length.size() == n && problem.position.rows() == n,
           "ParaView output: the reduced problem must have arc lengths and positions");
   require(!problem.chains.empty(), "ParaView output: the reduced problem has no chains, which "
                                    "say what nodes follow each other (one_chain() for all)");
}

void ContactLineFields::write(const ContactState &state)
{
   state.validate(problem_);
   const Eigen::Index n = problem_.nodes();
   const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
   const bool tangential = state.q.size() > 0;
   Eigen::VectorXd status(n);
   const std::vector<NodeState> settled = settled_states(problem_, state);
   for (Eigen::Index i = 0; i < n; ++i) { status[i] = static_cast<double>(settled[i]); }

   std::ostringstream vtp;
   vtp.precision(17);
   const auto array = [&vtp](const char *field_name, const Eigen::VectorXd &values)
   {
      vtp << "<DataArray type=\"Float64\" Name=\"" << field_name << "\" format=\"ascii\">\n";
      for (double value : values) { vtp << value << '\n'; }
      vtp << "</DataArray>\n";
   };
   vtp << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n"
       << "<Piece NumberOfPoints=\"" << n << "\" NumberOfVerts=\"0\" NumberOfLines=\""
       << problem_.chains.size() << "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<Points>\n"
       << "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n";
   for (Eigen::Index i = 0; i < n; ++i)
   {
      vtp << problem_.position(i, 0) << ' ' << problem_.position(i, 1) << " 0\n";
   }
   vtp << "</DataArray>\n</Points>\n<Lines>\n"
       << "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
   Eigen::Index listed = 0;
   std::ostringstream offsets;
   for (const ContactChain &chain : problem_.chains)
   {
      for (Eigen::Index i = 0; i < chain.nodes; ++i) { vtp << chain.first + i << '\n'; }
      if (chain.loop) { vtp << chain.first << '\n'; } // closed on the screen, too
      listed += chain.nodes + (chain.loop ? 1 : 0);
      offsets << listed << '\n';
   }
   vtp << "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n"
       << offsets.str();
   vtp << "</DataArray>\n</Lines>\n<PointData>\n";
   array("arc_length", problem_.arc_length);
   if (!problem_.chains.empty() &&
       problem_.chains.front().interface != problem_.chains.back().interface)
   {
      Eigen::VectorXd which = none; // numbers of interfaces, in the order of the nodes
      double number = 0;
      for (std::size_t k = 0; k < problem_.chains.size(); ++k)
      {
         const ContactChain &chain = problem_.chains[k];
         number += k > 0 && chain.interface != problem_.chains[k - 1].interface ? 1 : 0;
         which.segment(chain.first, chain.nodes).setConstant(number);
      }
      array("interface", which);
   }
   array("gap", problem_.gap);
   array("state", status);
   array("p", tractions(problem_, state.p));
   array("q", tangential ? tractions(problem_, state.q) : none);
   array("slip", tangential ? state.v : none);
   array("opening", state.w + problem_.gap);
   vtp << "</PointData>\n</Piece>\n</PolyData>\n</VTKFile>\n";

   std::vector<double> times = times_; // become times_ once the files are written
   times.push_back(state.time);
   std::ostringstream pvd;
   pvd.precision(17);
   pvd << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" "
          "version=\"0.1\">\n<Collection>\n";
   const auto file = [this](std::size_t k) { return name_ + "_" + std::to_string(k) + ".vtp"; };
   for (std::size_t k = 0; k < times.size(); ++k)
   {
      pvd << "<DataSet timestep=\"" << times[k] << "\" part=\"0\" file=\"" << file(k)
          << "\"/>\n";
   }
   pvd << "</Collection>\n</VTKFile>\n";
   const std::string folder = directory_ + "/" + name_;
   make_folder(folder);
   write_whole(folder + "/" + file(times_.size()), vtp.str());
   write_whole(folder + "/" + name_ + ".pvd", pvd.str());
   times_ = std::move(times);
}

ReductionFields::ReductionFields(Reduction &reduction,
                                 const std::vector<const ElasticBody *> &bodies,
                                 const std::string &directory, const HalfPlane *half_plane)
   : reduction_(reduction), bodies_(bodies)
{
   if (reduction.problem.nodes() > 0)
   {
      contact_.emplace(reduction.problem, directory, "contact");
   }
   const std::size_t given = bodies.size() + (half_plane ? 1 : 0);
   require(given == reduction.bodies.size(), "ParaView output: ", given,
           " bodies are given, must be as many as in the reduction, ", reduction.bodies.size());
   const auto name = [&](std::size_t k)
   {
      const std::string &own = reduction.bodies[k].name;
      return own.empty() ? "body" + std::to_string(k + 1) : own;
   };
   for (std::size_t k = 0; k < bodies.size(); ++k)
   {
      fields_.push_back(std::make_unique<BodyFields>(*bodies[k], directory, name(k)));
   }
   if (half_plane)
   {
      below_ = std::make_unique<HalfPlaneFields>(*half_plane, reduction.bodies.back().line,
                                                 directory, name(bodies.size()));
   }
}

void ReductionFields::write(const ContactState &state)
{
   const bool first = Ranks::first_of_all();
   if (first && contact_) { contact_->write(state); }
   if (first && below_)
   {
      below_->write(forces_below(reduction_, state), state.time,
                    named(reduction_.problem, state.multipliers));
   }
   for (std::size_t k = 0; k < bodies_.size(); ++k)
   {
      // Where every rank has the whole body, only the first one writes it.
      if (!first && !bodies_[k]->ranks().several()) { continue; }
      fields_[k]->write(
         reduction_.displacement(static_cast<int>(k), state.v, state.w, state.multipliers),
         state.time, named(reduction_.problem, state.multipliers));
   }
}

} // namespace cattaneo
