//! A table as a Parquet file (<https://parquet.apache.org>): groups of a fixed number of rows, uncompressed, units in the metadata.
//! Equal tables are equal bytes.

use super::columns::{Column, ColumnType, SweepCell};
use parquet::basic::{LogicalType, Repetition, Type as PhysicalType};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::Result;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::sync::Arc;

/// Rows of a group.
pub const GROUP: usize = 16_384;

/// A file in memory; rows are added one by one.
pub struct ParquetTable {
    columns: Vec<Column>,
    writer: SerializedFileWriter<Vec<u8>>,
    group: Vec<Vec<SweepCell>>,
}

impl ParquetTable {
    /// An empty table; `metadata` are names and texts beside the units of the columns.
    pub fn new(columns: &[Column], metadata: &[(&str, &str)]) -> Result<ParquetTable> {
        let fields = columns.iter().map(|column| {
            let (physical, logical) = match column.takes {
                ColumnType::Whole => (PhysicalType::INT64, None),
                ColumnType::Number => (PhysicalType::DOUBLE, None),
                ColumnType::Text => (PhysicalType::BYTE_ARRAY, Some(LogicalType::String)),
            };
            let repetition = match column.takes {
                ColumnType::Number => Repetition::OPTIONAL,
                ColumnType::Whole | ColumnType::Text => Repetition::REQUIRED,
            };
            let field = Type::primitive_type_builder(&column.name, physical)
                .with_logical_type(logical)
                .with_repetition(repetition);
            field.build().map(Arc::new)
        });
        let fields = fields.collect::<Result<Vec<_>>>()?;
        let schema = Type::group_type_builder("sweep").with_fields(fields);
        let units: serde_json::Map<_, _> = columns
            .iter()
            .filter(|column| !column.unit.is_empty())
            .map(|column| (column.name.clone(), column.unit.clone().into()))
            .collect();
        let units = serde_json::Value::from(units).to_string();
        let mut notes = vec![KeyValue::new("units".to_owned(), units)];
        let texts = metadata.iter();
        notes.extend(texts.map(|(key, text)| KeyValue::new((*key).to_owned(), (*text).to_owned())));
        let properties = WriterProperties::builder()
            .set_created_by(format!("looselink {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(notes));
        let (schema, properties) = (Arc::new(schema.build()?), Arc::new(properties.build()));
        Ok(ParquetTable {
            columns: columns.to_vec(),
            writer: SerializedFileWriter::new(Vec::new(), schema, properties)?,
            group: Vec::new(),
        })
    }

    /// Adds a row, in the order of the columns.
    pub fn row(&mut self, cells: Vec<SweepCell>) -> Result<()> {
        self.group.push(cells);
        match self.group.len() {
            GROUP => self.write_group(),
            _ => Ok(()),
        }
    }

    /// The bytes of the file.
    pub fn finish(mut self) -> Result<Vec<u8>> {
        if !self.group.is_empty() {
            self.write_group()?;
        }
        self.writer.into_inner()
    }

    fn write_group(&mut self) -> Result<()> {
        let mut group = self.writer.next_row_group()?;
        for (k, column) in self.columns.iter().enumerate() {
            let cells = self.group.iter().map(|row| &row[k]);
            match column.takes {
                ColumnType::Whole => write_whole(&mut group, cells)?,
                ColumnType::Number => write_numbers(&mut group, cells)?,
                ColumnType::Text => write_texts(&mut group, cells)?,
            }
        }
        group.close()?;
        self.group.clear();
        Ok(())
    }
}

type RowGroup<'a> = SerializedRowGroupWriter<'a, Vec<u8>>;

fn write_whole<'c>(group: &mut RowGroup, cells: impl Iterator<Item = &'c SweepCell>) -> Result<()> {
    let values: Vec<i64> = cells
        .map(|cell| match cell {
            SweepCell::Whole(n) => *n,
            _ => 0,
        })
        .collect();
    if let Some(mut column) = group.next_column()? {
        column
            .typed::<Int64Type>()
            .write_batch(&values, None, None)?;
        column.close()?;
    }
    Ok(())
}

fn write_numbers<'c>(
    group: &mut RowGroup,
    cells: impl Iterator<Item = &'c SweepCell>,
) -> Result<()> {
    let values: Vec<Option<f64>> = cells
        .map(|cell| match cell {
            SweepCell::Number(value) => *value,
            SweepCell::Whole(n) => Some(*n as f64),
            SweepCell::Text(_) => None,
        })
        .collect();
    let present: Vec<f64> = values.iter().copied().flatten().collect();
    let levels: Vec<i16> = values.iter().map(|value| value.is_some().into()).collect();
    if let Some(mut column) = group.next_column()? {
        column
            .typed::<DoubleType>()
            .write_batch(&present, Some(&levels), None)?;
        column.close()?;
    }
    Ok(())
}

fn write_texts<'c>(group: &mut RowGroup, cells: impl Iterator<Item = &'c SweepCell>) -> Result<()> {
    let values: Vec<ByteArray> = cells
        .map(|cell| match cell {
            SweepCell::Text(text) => ByteArray::from(text.as_str()),
            _ => ByteArray::from(""),
        })
        .collect();
    if let Some(mut column) = group.next_column()? {
        column
            .typed::<ByteArrayType>()
            .write_batch(&values, None, None)?;
        column.close()?;
    }
    Ok(())
}
