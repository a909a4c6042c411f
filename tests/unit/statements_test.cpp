#include "expect_input_error.hpp"

#include <cattaneo/elastic/statements.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <gtest/gtest.h>

// What is written is the same as what is called.
namespace
{

using namespace cattaneo;

/// Side 1 is the bottom, 2 the right, 3 the top, 4 the left of 0 < x < 2, 0 < y < 1.
struct Block
{
   mfem::Mesh mesh = rectangle_mesh({0, 0.5, 1, 2}, {0, 1});
   ElasticBody body{mesh, 2, Material{1, 0.3}};
};

TEST(Statements, ValuesAreFunctions)
{
   const auto at = [](const char *text) { return scalar_field("load", text)(3, 5); };
   EXPECT_EQ(at("0.5"), 0.5);
   EXPECT_EQ(at("-41.5*x"), -41.5 * 3);
   EXPECT_EQ(at("1+2*x-y"), 1 + 6 - 5);
   EXPECT_EQ(at("x-.5e1-y+2*y"), 3 - 5 + 5);
   EXPECT_EQ(at("2x^2*y-(x-1)/2"), 2 * 9 * 5 - 1);
   EXPECT_EQ(at("-x^2+2^-1"), -9 + 0.5);
   EXPECT_EQ(at("2^3^2"), 512);
   EXPECT_EQ(at("8/4/2-3-2"), -4);
   EXPECT_EQ(at("max(x,y)+min(2*x,y)"), 5 + 5);
   EXPECT_DOUBLE_EQ(at("10*exp(-(x-2)^2)+sqrt(y+4)"), 10 * std::exp(-1) + 3);
   EXPECT_DOUBLE_EQ(at("sin(pi*x/6)+abs(-y)"), 6);
   EXPECT_EQ(scalar_field("load", "r+2*z+x", Formulation::axisymmetric)(3, 5), 16);
   for (const char *text :
        {"", "+", "1+", "2**x", "2*", "1e999", "1+2*z", "(x", "x)", "0x10", "sin x", "r"})
   {
      expect_input_error([&] { scalar_field("load", text); },
                         "load: '" + std::string(text) +
                            "' is not a number or a function of x and y such as "
                            "1-3*x+2*sqrt(y)");
   }
}

TEST(Statements, SupportsAreThoseOfTheCalls)
{
   Block written, called;
   add_supports(written.body, "support1", "1:xy  2,4:x; @1,1:y");
   for (int component : {0, 1}) { called.body.fix(1, component); }
   called.body.fix(std::vector<int>{2, 4}, 0);
   called.body.fix_node(1, 1, 1);
   EXPECT_EQ(written.body.essential_dofs().Size(), called.body.essential_dofs().Size());
   for (int k = 0; k < called.body.essential_dofs().Size(); ++k)
   {
      EXPECT_EQ(written.body.essential_dofs()[k], called.body.essential_dofs()[k]);
   }
   const auto refused = [&](const char *text, const char *part)
   {
      Block block;
      expect_input_error([&] { add_supports(block.body, "support1", text); }, part);
   };
   refused("1", "support1 '1': must be attributes:components");
   refused("1:z", "component 'z', must be x, y or xy");
   refused("0:x", "'0', must be names or boundary attributes");
   refused("x:x", "'x', must be names or boundary attributes");
   refused(":x", "'', must be names or boundary attributes");
   refused("9:x", "9");
   refused("@1:x", "'@1', must be a point");
   refused("@1,a:x", "'a' is not a number");
   refused("@1,1.5:x", "(1, 1.5) lies outside of the body");
}

TEST(Statements, LoadsAreThoseOfTheCalls)
{
   Block written, called;
   add_loads(written.body, "load1",
             "P pressure 3 2*x; P traction 2 0.5 -y\n Q pressure 3[0.2<x<1.5] 1; "
             "G body-force 0 -9.81;D displacement-x 4 0.01; E displacement-y 1,2 y");
   called.body.add_pressure("P", 3, [](double x, double) { return 2 * x; });
   called.body.add_traction("P", 2, 0.5, [](double, double y) { return -y; });
   called.body.add_pressure("Q", BoundaryPart({3}, 0, 0.2, 1.5), 1.0);
   called.body.add_body_force("G", 0.0, -9.81);
   called.body.add_displacement("D", 4, 0, 0.01);
   called.body.add_displacement("E", std::vector<int>{1, 2}, 1,
                                [](double, double y) { return y; });
   ASSERT_EQ(written.body.patterns().size(), 5u);
   for (std::size_t k = 0; k < 5; ++k)
   {
      const BodyLoad &one = written.body.patterns()[k], &other = called.body.patterns()[k];
      EXPECT_EQ(one.name, other.name);
      EXPECT_EQ(one.control, other.control);
      EXPECT_EQ(one.values, other.values) << one.name;
   }
   // A strain in all directions, and one with directions of its own.
   Block strained, tensor;
   add_loads(strained.body, "load", "S initial-strain 2*x; S initial-strain 1 2*x y^2 4");
   tensor.body.add_initial_strain("S", [](double x, double) { return 2 * x; });
   mfem::MatrixFunctionCoefficient strain(3,
                                          [](const mfem::Vector &x, mfem::DenseMatrix &e)
                                          {
                                             e = 0.0;
                                             e(0, 0) = 1;
                                             e(1, 1) = 2 * x(0);
                                             e(0, 1) = e(1, 0) = x(1) * x(1);
                                             e(2, 2) = 4;
                                          });
   tensor.body.add_initial_strain("S", strain);
   const Eigen::VectorXd &one = strained.body.patterns()[0].values,
                         &other = tensor.body.patterns()[0].values;
   for (int i = 0; i < one.size(); ++i) { EXPECT_DOUBLE_EQ(one[i], other[i]); }
   const auto refused = [&](const std::string &text, const std::string &part)
   {
      Block block;
      expect_input_error([&] { add_loads(block.body, "load1", text); }, part);
   };
   refused("P", "load1 'P': must be PATTERN KIND WHERE VALUES");
   refused("P push 3 1", "kind 'push' is not one of pressure, traction, body-force");
   refused("P pressure 3", "has 3 words, must be PATTERN pressure WHERE p");
   refused("P traction 3 1", "must be PATTERN traction WHERE tx ty");
   refused("P pressure 3[0<z<1] 1", "axis of the interval is 2, must be 0 (x) or 1 (y)");
   refused("P pressure 3[0<t<1] 1", "'3[0<t<1]', must be names or boundary attributes");
   refused("P pressure 3[0<x<1 1", "must be names or boundary attributes");
   refused("P pressure 3[a<x<1] 1", "'a' is not a number");
   refused("P=1 pressure 3 1", "must not hold =, a comma or a quote");
   refused("\xff pressure 3 1", "not UTF-8");
}

/// Attributes that supports hold, by number and by name; nodes at points are none.
TEST(Statements, TellWhichAttributesAreHeld)
{
   const BodyTerms terms{{{"wall", {7}}}, true, 0};
   EXPECT_EQ(supported_attributes("support", "4:x 2,3[0<y<1]:xy;@0,1:x wall:y", terms),
             (std::vector<int>{4, 2, 3, 7}));
   EXPECT_TRUE(supported_attributes("support", "").empty());
}

} // namespace
