#include "comparison.hpp"
#include "expect_input_error.hpp"
#include "small_problems.hpp"

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/elastic/stress.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/output/history.hpp>
#include <cattaneo/output/paraview.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace
{

using cattaneo_test::four_springs;

using namespace cattaneo;
namespace fs = std::filesystem;

/// An empty folder of its own for each test.
class Output : public testing::Test
{
protected:
   void SetUp() override
   {
      folder = testing::TempDir() + "output";
      fs::remove_all(folder);
      fs::create_directories(folder);
   }
   void TearDown() override { fs::remove_all(folder); }
   std::string folder;
};

void write_nodes(const std::string &file, const ReducedProblem &problem,
                 const std::vector<ContactState> &states)
{
   NodeWriter nodes(file, problem);
   for (const ContactState &state : states) { nodes.add(state); }
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
   ContactLineFields contact(reduction.problem, folder, "contact");
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

TEST_F(Output, AReductionIsWrittenAsTheMarchGoes)
{
   mfem::Mesh mesh = two_materials_mesh();
   ElasticBody body(mesh, 2, Material{1, 0.3, PlaneState::strain});
   body.fix_node(0, 2, 0);
   body.add_pressure("P", 3, 0.25);
   const ContactLine line = contact_line(body, 1);
   Reduction reduction = reduce(condense(body, line));
   set_friction(reduction.problem, 0.2);
   std::vector<ContactState> states;
   {
      ReductionFields fields(reduction, {&body}, folder + "/together");
      EXPECT_EQ(reduction.counters.field_recoveries, 0);
      ContactState state = ContactState::virgin(reduction.problem);
      march(reduction.problem,
            LoadHistory::through(reduction.problem, {{}, {{"P", 1}}, {{"P", 0}}}), state, {},
            [&](const ContactState &now, const IncrementRecord &)
            {
               fields.write(now);
               states.push_back(now);
               EXPECT_EQ(reduction.counters.field_recoveries, states.size());
            });
   }
   ASSERT_GT(states.size(), 2u);
   BodyFields alone(body, folder + "/alone", "body1");
   ContactLineFields contact(reduction.problem, folder + "/alone", "contact");
   for (const ContactState &state : states)
   {
      contact.write(state);
      alone.write(reduction.displacement(0, state.v, state.w, state.multipliers), state.time);
   }
   std::size_t compared = 0;
   for (const auto &entry : fs::recursive_directory_iterator(folder + "/alone"))
   {
      if (!entry.is_regular_file()) { continue; }
      const fs::path twin =
         fs::path(folder + "/together") / fs::relative(entry.path(), folder + "/alone");
      EXPECT_EQ(content(twin), content(entry.path())) << twin;
      ++compared;
   }
   EXPECT_GE(compared, 2 * states.size() + 2);
   EXPECT_THROW(ReductionFields(reduction, {}, folder), InputError);
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

TEST_F(Output, CurvedElementsAreWrittenAsTheyAre)
{
   // One Lagrange quadrilateral for each element, not pieces of it with straight edges.
   mfem::Mesh mesh = two_materials_mesh();
   ElasticBody body(mesh, 2, Material{});
   BodyFields fields(body, folder, "body");
   fields.write(linear_field(body), 1);
   int files = 0;
   for (const auto &entry : fs::recursive_directory_iterator(folder))
   {
      if (entry.path().extension() != ".vtu") { continue; }
      ++files;
      EXPECT_NE(content(entry.path()).find("NumberOfCells=\"6\""), std::string::npos);
   }
   EXPECT_EQ(files, 1);
}

TEST_F(Output, AUsersOperatorHasDisplacementsOnly)
{
   mfem::Mesh mesh = two_materials_mesh();
   const ElasticBody isotropic(mesh, 1, Material{});
   ElasticBody body(isotropic.space(), isotropic.stiffness());
   BodyFields fields(body, folder, "body");
   EXPECT_EQ(fields.field("displacement").Normlinf(), 0); // before anything is written
   fields.write(linear_field(body), 1);
   EXPECT_NEAR(fields.field("displacement").Max(), 2e-3 * 1.5 + 1e-3 * 2, 1e-15);
   // A body without material has no stress.
   expect_input_error([&] { fields.field("von_mises"); },
                      "'von_mises'; there are: displacement");
}

/// Three nodes in two chains, with awkward numbers.
ReducedProblem three_nodes()
{
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero(),
                         Eigen::Matrix3d::Identity());
   problem.patterns = {{"P", Control::force, Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}};
   problem.H = Eigen::MatrixXd::Zero(1, 1);
   problem.gap = Eigen::Vector3d(0, 0, 0.1);
   problem.weights = Eigen::Vector3d(0.5, 0.5, 0.25);
   problem.chains = one_chain(3);
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
   ReducedProblem problem = three_nodes();
   problem.chains = {{"contact", 0, 2}, {"contact", 2, 1}};
   ContactLineFields fields(problem, folder, "contact");
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

TEST_F(Output, AClosedLineIsDrawnClosed)
{
   ReducedProblem problem = three_nodes();
   problem.chains = {{"contact", 0, 3, true}};
   ContactLineFields(problem, folder, "hole").write(some_state(problem));
   const std::string vtp = content(folder + "/hole/hole_0.vtp");
   EXPECT_NE(vtp.find("Name=\"connectivity\" format=\"ascii\">\n0\n1\n2\n0\n<"),
             std::string::npos)
      << vtp;
   EXPECT_NE(vtp.find("Name=\"offsets\" format=\"ascii\">\n4\n<"), std::string::npos);
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
   record.multipliers = state.multipliers;
   record.conjugates = Eigen::VectorXd::Constant(1, 2.0 / 7);
   HistoryWriter(folder + "/history.csv", problem).add(state, record);
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
   // The displacement comes before the method, which nobody named, and the node of an event.
   const std::size_t end = history.rfind(",,-1\n");
   ASSERT_NE(end, std::string::npos) << history;
   EXPECT_EQ(std::stod(history.substr(history.rfind(',', end - 1) + 1)), 2.0 / 7);

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
   problem.patterns[0].name = "P\nQ";
   EXPECT_THROW(HistoryWriter(folder + "/history.csv", problem), InputError);
   fs::remove(folder + "/taken");
   EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(Output, AStateThatIsNotOfTheProblemLeavesTheTableAsItWas)
{
   const ReducedProblem problem = three_nodes();
   const ContactState state = some_state(problem);
   ContactState wrong = state;
   wrong.p.resize(2);
   NodeWriter nodes(folder + "/nodes.csv", problem);
   nodes.add(state);
   const std::string before = content(folder + "/nodes.csv");
   EXPECT_THROW(nodes.add(wrong), InputError);
   EXPECT_EQ(content(folder + "/nodes.csv"), before);
}

/// A CSV file: the words of each column by its name.
std::map<std::string, std::vector<std::string>> columns_of(const std::string &file)
{
   std::istringstream text(content(file));
   std::string line, word;
   std::vector<std::string> names;
   std::map<std::string, std::vector<std::string>> result;
   while (std::getline(text, line))
   {
      std::istringstream words(line);
      std::size_t k = 0;
      const bool header = names.empty();
      for (; std::getline(words, word, ','); ++k)
      {
         if (header)
         {
            names.push_back(word);
            EXPECT_EQ(result.count(word), 0u) << word;
            result[word];
         }
         else if (k < names.size()) { result[names[k]].push_back(word); }
      }
      EXPECT_EQ(k, names.size()) << line;
   }
   return result;
}

std::vector<double> numbers(const std::vector<std::string> &words)
{
   std::vector<double> result;
   for (const std::string &word : words) { result.push_back(std::stod(word)); }
   return result;
}

void expect_values(const std::vector<double> &found, const std::vector<double> &expected,
                   const std::string &what, double tolerance = 1e-12)
{
   ASSERT_EQ(found.size(), expected.size()) << what;
   for (std::size_t i = 0; i < found.size(); ++i)
   {
      EXPECT_NEAR(found[i], expected[i], tolerance) << what << ' ' << i;
   }
}

TEST_F(Output, ColumnsAreThoseOfAStateSolvedByHand)
{
   const ReducedProblem problem = four_springs();
   HistoryWriter history(folder + "/history.csv", problem);
   std::vector<ContactState> states;
   ContactState state = ContactState::virgin(problem);
   const auto keep = [&](const ContactState &now, const IncrementRecord &record)
   {
      history.add(now, record);
      if (now.time == 1 || now.time == 2) { states.push_back(now); }
   };
   using Eigen::Vector2d;
   const LoadHistory path =
      LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1)});
   ASSERT_EQ(march(problem, path, state, {}, keep).status, FrictionStatus::converged);
   ASSERT_EQ(states.size(), 2u);
   states[0].status[0] = NodeState::forward_slip; // but it has not moved: stick
   write_nodes(folder + "/nodes.csv", problem, states);
   auto nodes = columns_of(folder + "/nodes.csv");
   const std::map<std::string, std::vector<double>> expected = {
      {"time", {1, 1, 1, 1, 2, 2, 2, 2}},
      {"node", {0, 1, 2, 3, 0, 1, 2, 3}},
      {"arc_length", {0, 1.0 / 3, 0.5, 2, 0, 1.0 / 3, 0.5, 2}},
      {"x", {-1, -2, -3, -4, -1, -2, -3, -4}},
      {"y", {5, 6, 7, 1.0 / 7, 5, 6, 7, 1.0 / 7}},
      {"p", {4, 2, 1, 0, 4, 2, 1, 0}},
      {"q", {0, 0, 0, 0, 0.4, -1, 0.5, 0}},
      {"slip", {0, 0, 0, 0, 0, 0.15, -0.1, -0.15}},
      {"opening", {0, 0, 0, 0.15, 0, 0, 0, 0.15}}};
   EXPECT_EQ(nodes.size(), expected.size() + 1);
   for (const auto &[column, values] : expected)
   {
      expect_values(numbers(nodes[column]), values, column);
   }
   EXPECT_EQ(nodes["state"],
             (std::vector<std::string>{"stick", "stick", "stick", "separation", "stick",
                                       "forward slip", "backward slip", "separation"}));

   auto table = columns_of(folder + "/history.csv");
   const auto last = [&](const char *column)
   { return table[column].empty() ? -1 : std::stod(table[column].back()); };
   EXPECT_EQ(last("time"), 2);
   EXPECT_EQ(last("load P"), 1);
   EXPECT_EQ(last("load Q right"), 1);
   EXPECT_EQ(last("stick"), 1);
   EXPECT_EQ(last("separation"), 1);
   EXPECT_EQ(last("forward_slip"), 1);
   EXPECT_EQ(last("backward_slip"), 1);
   double lost = 0;
   for (double loss : numbers(table["dissipation"])) { lost += loss; }
   EXPECT_NEAR(lost, 0.5 * (0.15 + 0.1), 1e-12); // f p |v| at p = 1
   EXPECT_LT(last("residual_normal"), 1e-10);
   EXPECT_LT(last("residual_tangential"), 1e-10);
}

TEST_F(Output, EachColumnOfTheHistoryIsItsOwn)
{
   IncrementRecord record;
   record.time = 1.0 / 3;
   record.cycle = 2;
   record.stick = 3;
   record.separation = 4;
   record.forward_slip = 5;
   record.backward_slip = 6;
   record.slip = 7;
   record.dissipation = 8.1;
   record.external_work = -9.1;
   record.residual_normal = 1e-10;
   record.residual_tangential = 1e-11;
   record.round_off = 1e-12;
   record.found_by = "event path";
   record.event = 9;
   ReducedProblem problem = four_springs();
   problem.patterns[0].size = {"force", 2, {1, 0}, "a face"};
   ContactState state = ContactState::virgin(problem);
   state.dissipation = 8.2;
   record.multipliers = Eigen::Vector2d(0.1, -0.7);
   record.conjugates = Eigen::Vector2d(3.5, -4.5);
   const auto read = [&]
   {
      HistoryWriter table(folder + "/history.csv", problem);
      table.add(state, record);
      record.cycle = 20;
      table.add(state, record);
      record.cycle = 2;
      return columns_of(folder + "/history.csv");
   };
   std::map<std::string, std::vector<std::string>> plane = read();
   const auto expect = [](std::map<std::string, std::vector<std::string>> &table,
                          const std::map<std::string, double> &expected)
   {
      // The method is a word, which is compared by itself.
      EXPECT_EQ(table["found_by"], (std::vector<std::string>{"event path", "event path"}));
      EXPECT_EQ(table.size(), expected.size() + 1);
      for (const auto &[column, value] : expected)
      {
         // The energy lost by then is the state's, the same in both rows of this test.
         const double second = column == "cycle" ? 20 : value;
         expect_values(numbers(table[column]), {value, second}, column, 0);
      }
   };
   std::map<std::string, double> common = {{"time", 1.0 / 3},
                                           {"cycle", 2},
                                           {"load P", 0.1},
                                           {"load Q right", -0.7},
                                           {"stick", 3},
                                           {"separation", 4},
                                           {"dissipation", 8.1},
                                           {"total_dissipation", 8.2},
                                           {"external_work", -9.1},
                                           {"residual_normal", 1e-10},
                                           {"residual_tangential", 1e-11},
                                           {"round_off", 1e-12},
                                           {"event", 9},
                                           {"displacement P", 1.75}, // of a force of 2
                                           {"displacement per unit of Q right", -4.5}};
   std::map<std::string, double> expected = common;
   expected["forward_slip"] = 5;
   expected["backward_slip"] = 6;
   expect(plane, expected);
   // With torsion slip has a direction of its own.
   problem.set_stiffness(Eigen::MatrixXd::Identity(8, 8), Eigen::MatrixXd::Zero(4, 8),
                         problem.C());
   std::map<std::string, std::vector<std::string>> disc = read();
   expected = common;
   expected["slip"] = 7;
   expect(disc, expected);

   // Whatever would break the table is said, and no row is written.
   fs::remove(folder + "/history.csv");
   for (const std::string name : {"a\nb", "a\rb"})
   {
      problem.patterns[1].name = name;
      expect_input_error([&] { read(); }, "'" + name + "' has a line break");
   }
   EXPECT_TRUE(fs::is_empty(folder));
   // Names with a comma, as a lap joint's are, or a quote stand in quotes.
   problem.patterns[0].name = "bolt 1, w = 1";
   problem.patterns[1].name = "a \"b\"";
   HistoryWriter(folder + "/quoted.csv", problem).add(state, record);
   const std::string quoted = content(folder + "/quoted.csv");
   EXPECT_EQ(quoted.rfind("time,cycle,\"load bolt 1, w = 1\",\"load a \"\"b\"\"\",stick,", 0),
             0u)
      << quoted;
   EXPECT_NE(quoted.find(",\"displacement bolt 1, w = 1\",\"displacement per unit of a "
                         "\"\"b\"\"\",found_by,event\n"),
             std::string::npos)
      << quoted;
   problem.chains = {{"left, upper", 0, 2}, {"right", 2, 2}};
   write_nodes(folder + "/quoted.csv", problem, {ContactState::virgin(problem)});
   EXPECT_EQ(occurrences(content(folder + "/quoted.csv"), ",\"left, upper\","), 2);
   problem.patterns.pop_back();
   EXPECT_THROW(read(), InputError); // two multipliers for one pattern
   EXPECT_EQ(occurrences(content(folder + "/history.csv"), "\n"), 1);
}

TEST_F(Output, NodesWithTorsionAndWithoutFriction)
{
   ReducedProblem problem = four_springs();
   problem.set_stiffness(Eigen::MatrixXd::Identity(8, 8), Eigen::MatrixXd::Zero(4, 8),
                         problem.C());
   for (LoadPattern &pattern : problem.patterns) { pattern.q = Eigen::VectorXd::Zero(8); }
   ContactState state = ContactState::virgin(problem);
   state.p << 1, 1, 1, 0;
   state.q << 0.1, 0.2, 0.3, 0, -0.4, -0.6, 0.4, 0; // first tangents, then second ones
   state.v << 1, 2, 3, 4, 5, 6, 7, 8;
   state.w << 0, 0, 0, 0.25;
   state.status = {NodeState::slip, NodeState::slip, NodeState::stick, NodeState::separation};
   write_nodes(folder + "/disc.csv", problem, {state});
   auto disc = columns_of(folder + "/disc.csv");
   EXPECT_EQ(disc.size(), 12u);
   expect_values(numbers(disc["p"]), {4, 2, 1, 0}, "p");
   expect_values(numbers(disc["q1"]), {0.4, 0.4, 0.3, 0}, "q1");
   expect_values(numbers(disc["q2"]), {-1.6, -1.2, 0.4, 0}, "q2");
   expect_values(numbers(disc["slip1"]), {1, 2, 3, 4}, "slip1");
   expect_values(numbers(disc["slip2"]), {5, 6, 7, 8}, "slip2");
   expect_values(numbers(disc["opening"]), {0, 0, 0, 0.3}, "opening");
   EXPECT_EQ(disc["state"], (std::vector<std::string>{"slip", "slip", "stick", "separation"}));

   ReducedProblem smooth = four_springs();
   smooth.set_stiffness({}, Eigen::MatrixXd(4, 0), smooth.C());
   for (LoadPattern &pattern : smooth.patterns) { pattern.q.resize(0); }
   ContactState pressed = ContactState::virgin(smooth);
   pressed.p << 1, 1, 1, 0;
   write_nodes(folder + "/smooth.csv", smooth, {pressed});
   auto plain = columns_of(folder + "/smooth.csv");
   EXPECT_EQ(plain.size(), 10u);
   expect_values(numbers(plain["p"]), {4, 2, 1, 0}, "p");
   for (const char *column : {"q", "slip"})
   {
      expect_values(numbers(plain[column]), {0, 0, 0, 0}, column);
   }
   smooth.chains = one_chain(4);
   ContactLineFields(smooth, folder, "smooth").write(pressed);
   EXPECT_TRUE(fs::exists(folder + "/smooth/smooth_0.vtp"));

   for (Eigen::VectorXd ReducedProblem::*list :
        {&ReducedProblem::arc_length, &ReducedProblem::weights})
   {
      ReducedProblem without = smooth;
      (without.*list).resize(0);
      EXPECT_THROW(write_nodes(folder + "/no.csv", without, {pressed}), InputError);
   }
   smooth.position.resize(0, 0);
   EXPECT_THROW(write_nodes(folder + "/no.csv", smooth, {pressed}), InputError);
   EXPECT_FALSE(fs::exists(folder + "/no.csv"));
}

/// Numbers of the data array of that name ("": the points) in a file of VTK.
std::vector<double> array_of(const std::string &vtk, const std::string &name)
{
   const std::string key = name.empty() ? "NumberOfComponents=\"3\"" : "Name=\"" + name + "\"";
   EXPECT_EQ(occurrences(vtk, key), 1) << name;
   std::istringstream values(vtk.substr(vtk.find('>', vtk.find(key)) + 1));
   std::vector<double> result;
   for (std::string word; values >> word && word[0] != '<';)
   {
      result.push_back(std::stod(word));
   }
   return result;
}

TEST_F(Output, AContactLineIsReadBackArrayByArray)
{
   ReducedProblem problem = four_springs();
   problem.chains = {{"contact", 0, 3}, {"contact", 3, 1}};
   ContactState state = ContactState::virgin(problem);
   using Eigen::Vector2d;
   march(problem, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1)}),
         state);
   ContactLineFields fields(problem, folder, "line");
   const ContactState virgin = ContactState::virgin(problem);
   fields.write(virgin);
   state.time = 1.0 / 3;
   state.status[0] = NodeState::forward_slip; // but it has not moved: stick
   fields.write(state);
   const std::string vtp = content(folder + "/line/line_1.vtp");
   EXPECT_NE(vtp.find("NumberOfPoints=\"4\" NumberOfVerts=\"0\" NumberOfLines=\"2\""),
             std::string::npos);
   const std::map<std::string, std::vector<double>> expected = {
      {"", {-1, 5, 0, -2, 6, 0, -3, 7, 0, -4, 1.0 / 7, 0}},
      {"connectivity", {0, 1, 2, 3}},
      {"offsets", {3, 4}},
      {"arc_length", {0, 1.0 / 3, 0.5, 2}},
      {"gap", {0, 0, 0, 0.05}},
      {"state", {0, 2, 3, 1}},
      {"p", {4, 2, 1, 0}},
      {"q", {0.4, -1, 0.5, 0}},
      {"slip", {0, 0.15, -0.1, -0.15}},
      {"opening", {0, 0, 0, 0.15}}};
   for (const auto &[name, values] : expected)
   {
      expect_values(array_of(vtp, name), values, name);
   }
   EXPECT_EQ(occurrences(vtp, "<DataArray "), 10);
   EXPECT_EQ(occurrences(vtp, "</DataArray>"), 10);
   // Each time has the file of its own state.
   const std::string pvd = content(folder + "/line/line.pvd");
   EXPECT_NE(pvd.find("timestep=\"0\" part=\"0\" file=\"line_0.vtp\""), std::string::npos)
      << pvd;
   EXPECT_NE(pvd.find("timestep=\"0.33333333333333331\" part=\"0\" file=\"line_1.vtp\""),
             std::string::npos)
      << pvd;
   expect_values(array_of(content(folder + "/line/line_0.vtp"), "slip"), {0, 0, 0, 0}, "slip");
   expect_values(array_of(content(folder + "/line/line_0.vtp"), "opening"), {0, 0, 0, 0.05},
                 "opening");

   // What cannot be shown is refused.
   ReducedProblem bad = problem;
   bad.chains.clear();
   EXPECT_THROW(ContactLineFields(bad, folder, "x"), InputError);
   bad = problem;
   bad.arc_length.resize(0);
   EXPECT_THROW(ContactLineFields(bad, folder, "x"), InputError);
   bad = problem;
   bad.position.resize(0, 0);
   EXPECT_THROW(ContactLineFields(bad, folder, "x"), InputError);
   bad = problem;
   bad.K = Eigen::MatrixXd::Identity(12, 12);
   EXPECT_THROW(ContactLineFields(bad, folder, "x"), InputError);
   state.p.resize(3);
   EXPECT_THROW(fields.write(state), InputError);
}

TEST_F(Output, AFailedWriteIsSaidAndLeavesTheSeriesAsItWas)
{
   ReducedProblem problem = four_springs();
   problem.chains = one_chain(4);
   ContactState state = ContactState::virgin(problem);
   ContactLineFields fields(problem, folder, "line");
   // A file stands where the folder is to be; then a folder where the file of time 1 is to be.
   std::ofstream(folder + "/line") << "taken";
   expect_input_error([&] { fields.write(state); },
                      "cannot make the folder '" + folder + "/line'");
   fs::remove(folder + "/line");
   fields.write(state);
   state.time = 1;
   fs::create_directories(folder + "/line/line_1.vtp");
   expect_input_error([&] { fields.write(state); }, "line_1.vtp");
   fs::remove(folder + "/line/line_1.vtp");
   state.time = 2;
   fields.write(state);
   const std::string pvd = content(folder + "/line/line.pvd");
   EXPECT_EQ(occurrences(pvd, "<DataSet"), 2) << pvd;
   EXPECT_NE(pvd.find("timestep=\"0\" part=\"0\" file=\"line_0.vtp\""), std::string::npos)
      << pvd;
   EXPECT_NE(pvd.find("timestep=\"2\" part=\"0\" file=\"line_1.vtp\""), std::string::npos)
      << pvd;
   EXPECT_TRUE(fs::exists(folder + "/line/line_1.vtp"));

   mfem::Mesh mesh = two_materials_mesh();
   const ElasticBody body(mesh, 1, Material{});
   std::ofstream(folder + "/file") << "taken";
   BodyFields inside(body, folder + "/file/in", "body"), outside(body, folder, "body");
   const mfem::Vector u = linear_field(body);
   expect_input_error([&] { inside.write(u, 1); },
                      "cannot make the folder '" + folder + "/file/in'");
   const mfem::Vector wrong(3);
   expect_input_error([&] { outside.write(wrong, 1); }, "3 displacements, the body has " +
                                                           std::to_string(u.Size()) +
                                                           " true dofs");
   EXPECT_FALSE(fs::exists(folder + "/body"));
   std::ofstream(folder + "/body") << "taken";
   expect_input_error([&] { outside.write(u, 1); },
                      "cannot write into the folder '" + folder + "'");
}

TEST_F(Output, FieldsOfBodiesOfRevolutionHaveTheirNames)
{
   mfem::Mesh mesh = rectangle_mesh({0, 0.4, 1}, {0, 0.7, 2});
   const Material material{2.6, 0.3}; // μ = 1, λ = 1.5
   // u_r = r z, u_z = r²: σ_rr = σ_θθ = 5 z, σ_zz = 3 z, τ_rz = 3 r; twist r z: τ_rθ = r z,
   // τ_θz = r².
   const ElasticBody body(mesh, 2, material, Formulation::axisymmetric),
      torsion(mesh, 2, material, Formulation::torsion);
   const auto dofs = [](const ElasticBody &of, const auto &value)
   {
      mfem::Vector u(of.space().GetTrueVSize());
      for (int node = 0; node < of.node_coordinates().Width(); ++node)
      {
         const double r = of.node_coordinates()(0, node), z = of.node_coordinates()(1, node);
         for (int c = 0; c < of.components(); ++c) { u(of.true_dof(node, c)) = value(r, z, c); }
      }
      return u;
   };
   BodyFields fields(body, folder, "body"), twisted(torsion, folder, "torsion");
   fields.write(dofs(body, [](double r, double z, int c) { return c == 0 ? r * z : r * r; }),
                1);
   twisted.write(dofs(torsion, [](double r, double z, int) { return r * z; }), 1);
   const auto expect = [](const BodyFields &of, const char *name, const auto &value)
   {
      const mfem::GridFunction &field = of.field(name);
      mfem::FunctionCoefficient exact([&](const mfem::Vector &x) { return value(x(0), x(1)); });
      EXPECT_LT(field.ComputeMaxError(exact), 1e-12) << name;
   };
   expect(fields, "sigma_rr", [](double, double z) { return 5 * z; });
   expect(fields, "sigma_zz", [](double, double z) { return 3 * z; });
   expect(fields, "sigma_tt", [](double, double z) { return 5 * z; });
   expect(fields, "tau_rz", [](double r, double) { return 3 * r; });
   expect(twisted, "tau_rt", [](double r, double z) { return r * z; });
   expect(twisted, "tau_tz", [](double r, double) { return r * r; });
   expect(twisted, "twist", [](double r, double z) { return r * z; });
   EXPECT_THROW(twisted.field("displacement"), InputError);
   expect_input_error([&] { fields.field("sigma_xx"); },
                      "ParaView output: there is no field 'sigma_xx'; there are: displacement, "
                      "sigma_rr, sigma_tt, sigma_zz, tau_rz, von_mises");
   // The files name the fields that they hold.
   for (const auto &[name, inside] :
        {std::pair<std::string, std::vector<std::string>>{
            "body",
            {"displacement", "sigma_rr", "sigma_zz", "sigma_tt", "tau_rz", "von_mises"}},
         {"torsion", {"twist", "tau_rt", "tau_tz"}}})
   {
      std::string written;
      for (const auto &entry : fs::recursive_directory_iterator(folder + "/" + name))
      {
         if (entry.path().extension() == ".pvtu") { written = content(entry.path()); }
      }
      for (const std::string &field : inside)
      {
         EXPECT_EQ(occurrences(written, "Name=\"" + field + "\""), 1) << field << written;
      }
   }
}

/// A block pressed and sheared on a half-plane: just below the contact are its tractions.
TEST_F(Output, FieldsBelowAHalfPlaneWithoutAMesh)
{
   mfem::Mesh mesh = rectangle_mesh(graded_to_ends(1, 20, 0.2), {0, 0.1, 0.3, 1, 2});
   ElasticBody block(mesh, 2, {0.91, 0.3});
   block.add_pressure("P", 3, 0.5);
   block.add_traction("Q", 3, 0.5, 0.0);
   block.add_pressure("Q", 3, [](double x, double) { return -3 * x; });
   HalfPlane below;
   below.material = {0.91, 0.3};
   below.depth = 100;
   below.point = {0.7, 0}; // which of its surface is its point does not matter
   Reduction reduction = reduce(condense(block, contact_line(block, 1)), below);
   set_friction(reduction.problem, 0.5);
   ContactState state = ContactState::virgin(reduction.problem);
   march(reduction.problem,
         LoadHistory::through(reduction.problem, {{}, {{"P", 1}}, {{"P", 1}, {"Q", 0.3}}}),
         state);
   EXPECT_THROW(ReductionFields(reduction, {&block}, folder), InputError);
   ReductionFields fields(reduction, {&block}, folder + "/fields", &below);
   fields.write(state);
   for (const char *name : {"body1", "body2", "contact"})
   {
      EXPECT_EQ(
         occurrences(content(folder + "/fields/" + name + "/" + name + ".pvd"), "<DataSet"), 1);
   }
   const Eigen::VectorXd p = tractions(reduction.problem, state.p),
                         q = tractions(reduction.problem, state.q);
   const HalfPlaneFields &inside = *fields.below();
   const mfem::GridFunction &sigma = inside.field("sigma_yy"), &tau = inside.field("tau_xy"),
                            &moved = inside.field("displacement");
   const mfem::Mesh &window = *sigma.FESpace()->GetMesh();
   int compared = 0;
   for (int e = 0; e < window.GetNE(); ++e)
   {
      mfem::Array<int> vertices, dofs;
      window.GetElementVertices(e, vertices);
      sigma.FESpace()->GetElementDofs(e, dofs);
      const double *x = window.GetVertex(vertices[0]);
      if (x[1] != 0) { continue; }
      for (Eigen::Index i = 0; i < p.size(); ++i)
      {
         const double at = reduction.problem.position(i, 0);
         if (std::abs(at - x[0]) > 1e-12 || std::abs(at) > 0.8) { continue; }
         ++compared;
         // Tractions of the consistent mass are those of lumped weights within the mesh's
         // error.
         EXPECT_NEAR(sigma(dofs[0]), -p[i], 0.03 * p[i]);
         EXPECT_NEAR(tau(dofs[0]), -q[i], 0.03 * p[i]);
         mfem::Array<int> both;
         moved.FESpace()->GetVertexVDofs(vertices[0], both);
         EXPECT_LT(moved(both[1]), 0); // pressed in, and drawn along
         EXPECT_GT(moved(both[0]), 0);
      }
   }
   EXPECT_GT(compared, 5);
   expect_input_error([&] { inside.field("sigma_rr"); }, "no field 'sigma_rr'");
   EXPECT_EQ(moved.FESpace()->GetNDofs(), window.GetNV()); // linear between vertices
   // The window reaches beyond both ends of the contact [-1, 1], as far as it is deep.
   mfem::Vector low, high;
   const_cast<mfem::Mesh &>(window).GetBoundingBox(low, high);
   EXPECT_NEAR(low[0], -4, 1e-9); // 1.5 lengths
   EXPECT_NEAR(low[0], -high[0], 1e-9);
   EXPECT_NEAR(high[1], 0, 1e-12);
   EXPECT_NEAR(low[1], low[0] + 1, 1e-9);
   double area = 0;
   for (int e = 0; e < window.GetNE(); ++e)
   {
      area += const_cast<mfem::Mesh &>(window).GetElementVolume(e);
   }
   EXPECT_NEAR(area, (high[0] - low[0]) * (high[1] - low[1]), 1e-9);
}

} // namespace
