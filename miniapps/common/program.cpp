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
      // A number without a default is NaN, which says nothing to the reader.
      const std::string none = ", current value: nan";
      std::stringstream text;
      options.PrintHelp(text);
      std::string help = text.str();
      for (auto at = help.find(none); at != std::string::npos; at = help.find(none))
      {
         help.erase(at, none.size());
      }
      std::cout << help;
      return false;
   }
   if (!options.Good())
   {
      std::ostringstream text;
      options.PrintError(text);
      // MFEM may leave the stream broken, so it is read from a copy of its text.
      std::istringstream lines(text.str());
      std::string line;
      while (line.empty() && std::getline(lines, line)) {}
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
