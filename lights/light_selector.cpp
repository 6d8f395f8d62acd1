// light_selector.cpp
