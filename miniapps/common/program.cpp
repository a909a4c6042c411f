#include <cattaneo/input_error.hpp>
#include <common/program.hpp>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>

namespace cattaneo::miniapp
{

bool parse(mfem::OptionsParser &options)
{
   options.Parse();
   if (options.Help())
   {
      options.PrintHelp(std::cout);
      return false;
   }
   if (!options.Good())
   {
      std::stringstream text;
      std::string line;
      options.PrintError(text);
      std::getline(text, line);
      throw InputError(line + " (-h shows the options)");
   }
   return true;
}

void echo(const mfem::OptionsParser &options)
{
   std::stringstream text;
   options.PrintOptions(text);
   for (std::string line; std::getline(text, line);)
   {
      // An option without a value is an empty text or, for a number, NaN.
      const std::string value = line.substr(line.rfind(' ') + 1);
      if (!value.empty() && value != "nan") { std::cout << line << "\n"; }
   }
}

int run(const std::string &program, const std::function<void()> &body)
{
   try
   {
      body();
      return 0;
   }
   catch (const std::exception &error)
   {
      std::cout.flush();
      std::cerr << program << ": " << error.what() << std::endl;
      return 1;
   }
}

void write_file(const std::string &path, const std::string &text)
{
   const std::string part = path + ".part";
   std::ofstream stream(part, std::ios::binary);
   stream << text;
   stream.close();
   const bool written = stream.good() && std::rename(part.c_str(), path.c_str()) == 0;
   if (!written) { std::remove(part.c_str()); }
   require(written, "cannot write ", path, ".");
}

} // namespace cattaneo::miniapp
