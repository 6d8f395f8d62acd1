// json_fields_test.cpp
