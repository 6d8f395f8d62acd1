# Puts the style sheet and the scripts that index.html names into it, so that the page is one file:
#   cmake -DSOURCE=sweep/report -DOUTPUT=build/report/index.html -P sweep/report/assemble.cmake
file(READ ${SOURCE}/index.html page)

file(READ ${SOURCE}/style.css text)
string(REPLACE "<link rel=\"stylesheet\" href=\"style.css\">" "<style>\n${text}</style>" page "${page}")

# The scripts of the page itself; those of a report (data.js, report.bundle.js) stay files of their own.
string(REGEX MATCHALL "src=\"[a-z_]+\\.js\" data-inline" names "${page}")
foreach(name IN LISTS names)
  string(REGEX REPLACE "src=\"([a-z_]+\\.js)\".*" "\\1" file "${name}")
  file(READ ${SOURCE}/${file} text)
  string(REPLACE "<script ${name}></script>" "<script>\n${text}</script>" page "${page}")
endforeach()

if(page MATCHES "data-inline|href=\"style.css\"")
  message(FATAL_ERROR "index.html: something was not put in")
endif()
file(WRITE ${OUTPUT} "${page}")
