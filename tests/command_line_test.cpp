// command_line_test.cpp
