//! Files a person opens: PNG and EXR pictures, eye views, contact sheets.
