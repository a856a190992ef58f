//! The page of a run.

use pyo3::prelude::*;
use std::path::PathBuf;

/// A page in which the mechanism of a run moves. In a notebook it shows itself; `save` and `open` are for a browser.
#[pyclass(module = "looselink", name = "View", frozen)]
pub struct PyView {
    pub page: String,
    /// In a notebook \[pixels\].
    pub height: u32,
}

#[pymethods]
impl PyView {
    /// The whole page: HTML that needs no network.
    #[getter]
    fn html(&self) -> &str {
        &self.page
    }

    /// The page in a frame of its own, for notebooks.
    fn _repr_html_(&self) -> String {
        let page = self.page.replace('&', "&amp;").replace('"', "&quot;");
        format!(
            "<iframe srcdoc=\"{page}\" width=\"100%\" height=\"{}\" style=\"border: 0\" allowfullscreen></iframe>",
            self.height
        )
    }

    fn __repr__(&self) -> String {
        format!("<looselink.View, {} bytes of HTML>", self.page.len())
    }

    /// Writes the page to a file.
    ///
    /// Raises OSError where it cannot be written.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        Ok(std::fs::write(path, &self.page)?)
    }

    /// Opens the page in a browser, from a temporary file, and returns the path of the file.
    ///
    /// Raises OSError where it cannot be written.
    fn open(&self, py: Python) -> PyResult<String> {
        let folder: PathBuf = py
            .import("tempfile")?
            .call_method1("mkdtemp", (py.None(), "looselink-"))?
            .extract()?;
        let path = folder.join("view.html");
        self.save(path.clone())?;
        let address = path.display().to_string();
        let open = py.import("webbrowser")?.getattr("open")?;
        open.call1((format!("file://{address}"),))?;
        Ok(address)
    }
}
