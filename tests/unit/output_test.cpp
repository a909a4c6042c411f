#include <cattaneo/condense/reduction.hpp>
#include <cattaneo/elastic/graded_mesh.hpp>
#include <cattaneo/elastic/stress.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/history.hpp>
#include <cattaneo/output/paraview.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <unistd.h>

namespace
{

using namespace cattaneo;
namespace fs = std::filesystem;

/// An empty folder of its own for each test.
class Output : public testing::Test
{
protected:
   void SetUp() override
   {
      folder = testing::TempDir() + "cattaneo_output_" + std::to_string(getpid());
      fs::remove_all(folder);
      fs::create_directories(folder);
   }
   void TearDown() override { fs::remove_all(folder); }
   std::string folder;
};

std::string content(const std::string &file)
{
   std::ifstream in(file);
   EXPECT_TRUE(in.good()) << file;
   std::ostringstream text;
   text << in.rdbuf();
   return text.str();
}

int occurrences(const std::string &text, const std::string &word)
{
   int count = 0;
   for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
   {
      ++count;
   }
   return count;
}

mfem::Mesh two_materials_mesh()
{
   mfem::Mesh mesh = rectangle_mesh({0, 0.4, 1, 1.5}, {0, 0.7, 2});
   for (int e = 0; e < mesh.GetNE(); ++e) { mesh.SetAttribute(e, 1 + e % 2); }
   mesh.SetAttributes();
   return mesh;
}

/// u_x = 2e-3 x + 1e-3 y, u_y = -3e-3 y + 5e-4 x.
mfem::Vector linear_field(const ElasticBody &body)
{
   mfem::VectorFunctionCoefficient linear(2,
                                          [](const mfem::Vector &x, mfem::Vector &u)
                                          {
                                             u(0) = 2e-3 * x(0) + 1e-3 * x(1);
                                             u(1) = -3e-3 * x(1) + 5e-4 * x(0);
                                          });
   mfem::GridFunction u(&body.space());
   u.ProjectCoefficient(linear);
   mfem::Vector dofs;
   u.GetTrueDofs(dofs);
   return dofs;
}

void expect_constant(const BodyFields &fields, const std::string &name, int attribute,
                     double value, double scale)
{
   const mfem::GridFunction &field = fields.field(name);
   const mfem::FiniteElementSpace &space = *field.FESpace();
   mfem::Array<int> dofs;
   for (int e = 0; e < space.GetNE(); ++e)
   {
      if (space.GetMesh()->GetAttribute(e) != attribute) { continue; }
      space.GetElementDofs(e, dofs);
      for (int dof : dofs) { EXPECT_NEAR(field(dof), value, 1e-12 * scale) << name; }
   }
}

TEST_F(Output, LinearDisplacementGivesTheStressOfEachElementsMaterial)
{
   mfem::Mesh mesh = two_materials_mesh();
   for (PlaneState state : {PlaneState::strain, PlaneState::stress})
   {
      const std::vector<Material> materials = {{200, 0.3, state}, {70, 0.2, state}};
      ElasticBody body(mesh, 2, materials);
      BodyFields fields(body, folder, "body");
      fields.write(linear_field(body), 0.5);
      for (int a : {1, 2})
      {
         // Hooke's law in three dimensions, from the compliances.
         const double E = materials[a - 1].young, nu = materials[a - 1].poisson;
         const double exx = 2e-3, eyy = -3e-3, gamma = 1.5e-3;
         const bool strain = state == PlaneState::strain;
         const double k = strain ? E / ((1 + nu) * (1 - 2 * nu)) : E / (1 - nu * nu);
         const double xx = strain ? k * ((1 - nu) * exx + nu * eyy) : k * (exx + nu * eyy);
         const double yy = strain ? k * ((1 - nu) * eyy + nu * exx) : k * (eyy + nu * exx);
         const double zz = strain ? nu * (xx + yy) : 0.0, xy = E / (2 * (1 + nu)) * gamma;
         const double mean = (xx + yy + zz) / 3;
         const double deviatoric = std::pow(xx - mean, 2) + std::pow(yy - mean, 2) +
                                   std::pow(zz - mean, 2) + 2 * xy * xy;
         expect_constant(fields, "sigma_xx", a, xx, E);
         expect_constant(fields, "sigma_yy", a, yy, E);
         expect_constant(fields, "sigma_zz", a, zz, E);
         expect_constant(fields, "tau_xy", a, xy, E);
         expect_constant(fields, "von_mises", a, std::sqrt(1.5 * deviatoric), E);
      }
   }
}

TEST_F(Output, ACompressedBlockIsRecoveredOnlyWhenItsFieldsAreWritten)
{
   const double pressure = 0.25;
   mfem::Mesh mesh = two_materials_mesh();
   ElasticBody body(mesh, 2, Material{1, 0.3, PlaneState::strain});
   body.fix_node(0, 2, 0);
   body.add_pressure("P", 3, pressure);
   const ContactLine line = contact_line(body, 1);
   Reduction reduction = reduce(condense(body, line));
   ContactState state = ContactState::virgin(reduction.problem);
   const MarchReport report =
      march(reduction.problem,
            LoadHistory::through({Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)}), state);
   ASSERT_EQ(report.status, FrictionStatus::converged);
   BodyFields fields(body, folder, "body");
   ContactLineFields contact(reduction.problem, line.chain, folder, "contact");
   contact.write(state);
   EXPECT_EQ(reduction.counters.field_recoveries, 0);
   EXPECT_FALSE(fs::exists(folder + "/body"));
   fields.write(reduction.displacement(0, state.v, state.w, state.multipliers), 1.0);
   EXPECT_EQ(reduction.counters.field_recoveries, 1);
   for (int a : {1, 2})
   {
      expect_constant(fields, "sigma_xx", a, 0, 10);
      expect_constant(fields, "sigma_yy", a, -pressure, 10);
      expect_constant(fields, "sigma_zz", a, -0.3 * pressure, 10);
      expect_constant(fields, "tau_xy", a, 0, 10);
      expect_constant(fields, "von_mises", a, pressure * std::sqrt(1 - 0.3 + 0.09), 10);
   }
}

TEST_F(Output, SeveralTimesMakeOneSeries)
{
   mfem::Mesh mesh = two_materials_mesh();
   ElasticBody body(mesh, 1, Material{});
   BodyFields fields(body, folder, "body");
   for (double time : {0.25, 0.5, 1.75}) { fields.write(linear_field(body), time); }
   const std::string pvd = content(folder + "/body/body.pvd");
   EXPECT_EQ(occurrences(pvd, "<DataSet"), 3);
   EXPECT_NE(pvd.find("1.75"), std::string::npos);
   int files = 0;
   for (const auto &entry : fs::recursive_directory_iterator(folder))
   {
      files += entry.path().extension() == ".vtu";
   }
   EXPECT_EQ(files, 3);
   const mfem::Vector wrong(3);
   EXPECT_THROW(fields.write(wrong, 2), InputError);
}

TEST_F(Output, AUsersOperatorHasDisplacementsOnly)
{
   mfem::Mesh mesh = two_materials_mesh();
   const ElasticBody isotropic(mesh, 1, Material{});
   ElasticBody body(isotropic.space(), isotropic.stiffness());
   BodyFields fields(body, folder, "body");
   fields.write(linear_field(body), 1);
   EXPECT_NEAR(fields.field("displacement").Max(), 2e-3 * 1.5 + 1e-3 * 2, 1e-15);
   try
   {
      fields.field("von_mises");
      FAIL() << "a body without material has no stress";
   }
   catch (const InputError &error)
   {
      EXPECT_NE(std::string(error.what()).find("'von_mises'; there are: displacement"),
                std::string::npos)
         << error.what();
   }
}

/// Three nodes in two chains, with awkward numbers.
ReducedProblem three_nodes()
{
   ReducedProblem problem;
   problem.A = Eigen::Matrix3d::Identity();
   problem.B = Eigen::Matrix3d::Zero();
   problem.C = Eigen::Matrix3d::Identity();
   problem.patterns = {{"P", Control::force, Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}};
   problem.H = Eigen::MatrixXd::Zero(1, 1);
   problem.gap = Eigen::Vector3d(0, 0, 0.1);
   problem.weights = Eigen::Vector3d(0.5, 0.5, 0.25);
   problem.arc_length = Eigen::Vector3d(0, 1.0 / 3, 1);
   problem.position.resize(3, 2);
   problem.position << 0, 0, 1.0 / 3, 0, 1, 0;
   set_friction(problem, 0.3);
   return problem;
}

ContactState some_state(const ReducedProblem &problem)
{
   ContactState state = ContactState::virgin(problem);
   state.time = 2.0 / 3;
   state.p = Eigen::Vector3d(0.1, 0.2, 0);
   state.q = Eigen::Vector3d(0.01, -0.06, 0);
   state.v = Eigen::Vector3d(0, 0.7, 0.4);
   state.w = Eigen::Vector3d(0, 0, 0.3);
   state.status[1] = NodeState::forward_slip;
   state.multipliers[0] = 1.0 / 7;
   return state;
}

TEST_F(Output, AContactLineIsOnePolylineForEachChain)
{
   const ReducedProblem problem = three_nodes();
   ContactLineFields fields(problem, {0, 0, 1}, folder, "contact");
   ContactState state = some_state(problem);
   fields.write(state);
   state.time = 5;
   fields.write(state);
   EXPECT_EQ(occurrences(content(folder + "/contact/contact.pvd"), "<DataSet"), 2);
   const std::string vtp = content(folder + "/contact/contact_1.vtp");
   EXPECT_NE(vtp.find("NumberOfPoints=\"3\""), std::string::npos);
   EXPECT_NE(vtp.find("NumberOfLines=\"2\""), std::string::npos);
   EXPECT_NE(vtp.find("Name=\"offsets\" format=\"ascii\">\n2\n3\n"), std::string::npos) << vtp;
   EXPECT_NE(vtp.find("Name=\"state\" format=\"ascii\">\n0\n2\n1\n"), std::string::npos) << vtp;
}

TEST_F(Output, TablesAreReadBackToTheLastBit)
{
   const ReducedProblem problem = three_nodes();
   const ContactState state = some_state(problem);
   IncrementRecord record;
   record.time = state.time;
   record.cycle = 4;
   record.stick = 1;
   record.dissipation = 0.1;
   HistoryTable table;
   table.add(state, record);
   table.write(folder + "/history.csv", problem);
   double time = 0, load = 0;
   int cycle = 0;
   char header[256];
   const std::string history = content(folder + "/history.csv");
   ASSERT_EQ(std::sscanf(history.c_str(), "%255s", header), 1);
   ASSERT_EQ(occurrences(history, "\n"), 2);
   ASSERT_EQ(std::sscanf(history.c_str() + history.find('\n'), "%lf,%d,%lf,1,0,0,0,", &time,
                         &cycle, &load),
             3)
      << history;
   EXPECT_EQ(time, state.time);
   EXPECT_EQ(cycle, 4);
   EXPECT_EQ(load, state.multipliers[0]);
   EXPECT_NE(history.find("time,cycle,load P,stick,"), std::string::npos);

   write_nodes(folder + "/nodes.csv", problem, {state, state});
   const std::string nodes = content(folder + "/nodes.csv");
   EXPECT_EQ(occurrences(nodes, "\n"), 7);
   double s = 0, p = 0, q = 0;
   ASSERT_EQ(std::sscanf(nodes.c_str() + nodes.find(",1,"),
                         ",1,%lf,%*[^,],0,forward slip,%lf,%lf,", &s, &p, &q),
             3)
      << nodes;
   EXPECT_EQ(s, 1.0 / 3);
   EXPECT_EQ(p, 0.2 / 0.5);
   EXPECT_EQ(q, -0.06 / 0.5);
}

TEST_F(Output, ATableThatCannotBeWrittenLeavesNothing)
{
   ReducedProblem problem = three_nodes();
   const ContactState state = some_state(problem);
   fs::create_directories(folder + "/taken");
   EXPECT_THROW(write_nodes(folder + "/taken", problem, {state}), InputError);
   EXPECT_THROW(write_nodes(folder + "/missing/nodes.csv", problem, {state}), InputError);
   ContactState wrong = state;
   wrong.p.resize(2);
   EXPECT_THROW(write_nodes(folder + "/nodes.csv", problem, {state, wrong}), InputError);
   HistoryTable table;
   table.add(state, {});
   problem.patterns[0].name = "P,Q";
   EXPECT_THROW(table.write(folder + "/history.csv", problem), InputError);
   fs::remove(folder + "/taken");
   EXPECT_TRUE(fs::is_empty(folder));
}

} // namespace
