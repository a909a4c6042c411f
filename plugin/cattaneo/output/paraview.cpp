#include <array>
#include <cattaneo/elastic/point_stress.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/friction/load_history.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/paraview.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/whole_file.hpp>
#include <map>
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
   if (formulation == Formulation::space)
   {
      return {"sigma_xx", "sigma_yy", "sigma_zz", "tau_xy", "tau_yz", "tau_xz", "von_mises"};
   }
   return {"sigma_rr", "sigma_zz", "sigma_tt", "tau_rz", "von_mises"};
}

const char *unknown(Formulation formulation)
{
   return formulation == Formulation::torsion ? "twist" : "displacement";
}

/// Writes one more file of a series, and the series anew. The times are kept when the files
/// are.
void add_to_series(const std::string &directory, const std::string &name,
                   std::vector<double> &all, double time, const std::string &vtp)
{
   std::vector<double> times = all;
   times.push_back(time);
   std::ostringstream pvd;
   pvd.precision(17);
   pvd << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" "
          "version=\"0.1\">\n<Collection>\n";
   const auto file = [&name](std::size_t k) { return name + "_" + std::to_string(k) + ".vtp"; };
   for (std::size_t k = 0; k < times.size(); ++k)
   {
      pvd << "<DataSet timestep=\"" << times[k] << "\" part=\"0\" file=\"" << file(k)
          << "\"/>\n";
   }
   pvd << "</Collection>\n</VTKFile>\n";
   const std::string folder = directory + "/" + name;
   make_folder(folder);
   write_whole(folder + "/" + file(all.size()), vtp);
   write_whole(folder + "/" + name + ".pvd", pvd.str());
   all = std::move(times);
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
      collection_ = std::make_unique<mfem::L2_FECollection>(order, space.GetMesh()->Dimension(),
                                                            mfem::BasisType::GaussLobatto);
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
         std::array<double, 7> values{};
         if (body_.formulation() == Formulation::torsion)
         {
            const TorsionStress s = torsion_stress_at(body_, u, transformation);
            values = {s.r_theta, s.theta_z};
         }
         else
         {
            const Stress s = stress_at(body_, u, transformation, loads);
            values = {s.xx, s.yy, s.zz, s.xy, s.von_mises()};
            if (body_.formulation() == Formulation::space)
            {
               values = {s.xx, s.yy, s.zz, s.xy, s.yz, s.xz, s.von_mises()};
            }
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

   add_to_series(directory_, name_, times_, state.time, vtp.str());
}

ContactSurfaceFields::ContactSurfaceFields(const Reduction &reduction,
                                           const std::string &directory,
                                           const std::string &name)
   : reduction_(reduction), directory_(directory), name_(name)
{
   const ReducedProblem &problem = reduction.problem;
   require(problem.position.cols() == 3 && problem.position.rows() == problem.nodes(),
           "ParaView output: the reduction is not in space, must be");
   for (const InterfaceReport &report : reduction.interfaces)
   {
      if (report.tied) { continue; }
      // Nodes of the body's surface by their first dof.
      const int owner = report.bodies[0];
      std::map<int, Eigen::Index> node_of;
      for (Eigen::Index i = report.first; i < report.first + report.nodes; ++i)
      {
         node_of[problem.dofs(i, 3 * owner)] = i;
      }
      const ContactSurface &surface = reduction.bodies[owner].surface;
      for (const std::vector<Eigen::Index> &face : surface.faces)
      {
         std::vector<Eigen::Index> own;
         for (const Eigen::Index node : face)
         {
            const auto found = node_of.find(surface.nodes[node].dofs[0]);
            if (found != node_of.end()) { own.push_back(found->second); }
         }
         if (own.size() != face.size()) { continue; }
         // Around the face, corners and middles of edges by turns.
         const std::size_t corners = own.size() == 3 || own.size() == 6 ? 3 : 4;
         std::vector<Eigen::Index> around;
         for (std::size_t k = 0; k < corners; ++k)
         {
            around.push_back(own[k]);
            if (own.size() > corners) { around.push_back(own[corners + k]); }
         }
         faces_.push_back(std::move(around));
      }
   }
}

void ContactSurfaceFields::write(const ContactState &state)
{
   const ReducedProblem &problem = reduction_.problem;
   state.validate(problem);
   const Eigen::Index n = problem.nodes();
   Eigen::MatrixX3d q = Eigen::MatrixX3d::Zero(n, 3), slip = q;
   Eigen::VectorXd status(n), which(n);
   const std::vector<NodeState> settled = settled_states(problem, state);
   for (Eigen::Index i = 0; i < n; ++i) { status[i] = static_cast<double>(settled[i]); }
   for (std::size_t k = 0; k < reduction_.interfaces.size(); ++k)
   {
      const InterfaceReport &report = reduction_.interfaces[k];
      for (Eigen::Index j = 0; j < report.nodes && !report.tied; ++j)
      {
         const Eigen::Index i = report.first + j;
         which[i] = static_cast<double>(k);
         for (int c = 0; c < 2 && state.q.size() > 0; ++c)
         {
            const auto tangent = report.frames.row(j).segment<3>(3 * c);
            q.row(i) += state.q[c * n + i] / problem.weights[i] * tangent;
            slip.row(i) += state.v[c * n + i] * tangent;
         }
      }
   }
   std::ostringstream vtp;
   vtp.precision(17);
   const auto array = [&vtp](const char *field_name, const Eigen::MatrixXd &values)
   {
      vtp << "<DataArray type=\"Float64\" Name=\"" << field_name << "\" NumberOfComponents=\""
          << values.cols() << "\" format=\"ascii\">\n"
          << values.format(Eigen::IOFormat(Eigen::StreamPrecision, Eigen::DontAlignCols))
          << "\n</DataArray>\n";
   };
   vtp << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n"
       << "<Piece NumberOfPoints=\"" << n
       << "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\""
       << faces_.size() << "\">\n<Points>\n";
   array("places", problem.position);
   vtp << "</Points>\n<Polys>\n"
       << "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
   std::size_t listed = 0;
   std::ostringstream offsets;
   for (const std::vector<Eigen::Index> &face : faces_)
   {
      for (const Eigen::Index node : face) { vtp << node << '\n'; }
      offsets << (listed += face.size()) << '\n';
   }
   vtp << "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n"
       << offsets.str() << "</DataArray>\n</Polys>\n<PointData>\n";
   if (reduction_.interfaces.size() > 1) { array("interface", which); }
   array("gap", problem.gap);
   array("state", status);
   array("p", tractions(problem, state.p));
   array("q", q);
   array("slip", slip);
   array("opening", state.w + problem.gap);
   vtp << "</PointData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
   add_to_series(directory_, name_, times_, state.time, vtp.str());
}

ReductionFields::ReductionFields(Reduction &reduction,
                                 const std::vector<const ElasticBody *> &bodies,
                                 const std::string &directory, const HalfPlane *half_plane)
   : reduction_(reduction), bodies_(bodies)
{
   const bool space = !bodies.empty() && bodies[0]->formulation() == Formulation::space;
   if (reduction.problem.nodes() > 0 && space)
   {
      surface_.emplace(reduction, directory, "contact");
   }
   else if (reduction.problem.nodes() > 0)
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
   if (first && surface_) { surface_->write(state); }
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
